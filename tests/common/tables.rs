//! Tables of documents whose numbers come from runs: compared with what is written, or written where that is asked for
//! (`scripts/tables`).

use std::path::Path;

/// Noise that a number of a table may have.
#[derive(Clone, Copy)]
pub enum Noise {
    /// Within 2 %, and half a unit of what is written.
    #[allow(dead_code)]
    Count,
    /// Within a factor of 3.
    #[allow(dead_code)]
    Size,
}

/// A row: words, and numbers as they are written with their noise.
pub struct Row {
    pub words: String,
    pub numbers: Vec<(String, Noise)>,
    /// Unit, or what the numbers are of.
    pub unit: &'static str,
}

/// A row.
pub fn row(words: impl Into<String>, numbers: Vec<(String, Noise)>, unit: &'static str) -> Row {
    Row { words: words.into(), numbers, unit }
}

impl Row {
    fn text(&self) -> String {
        if self.numbers.is_empty() {
            return format!("| {} |", self.words);
        }
        let numbers: Vec<&str> = self.numbers.iter().map(|(number, _)| number.as_str()).collect();
        format!("| {} | {}{} |", self.words, numbers.join(" / "), self.unit)
    }

    /// Does a line of the document say the same?
    fn agrees(&self, line: &str) -> bool {
        if self.numbers.is_empty() {
            return line == self.text();
        }
        let Some(written) = line
            .strip_prefix(&format!("| {} | ", self.words))
            .and_then(|rest| rest.strip_suffix(&format!("{} |", self.unit)))
        else {
            return false;
        };
        let written: Vec<&str> = written.split(" / ").collect();
        written.len() == self.numbers.len()
            && written.iter().zip(&self.numbers).all(|(written, (ours, noise))| {
                let digit = ours.split_once('.').map_or(1.0, |(_, digits)| 0.1f64.powi(digits.len() as i32));
                let (Ok(written), ours) = (written.parse::<f64>(), ours.parse::<f64>().unwrap()) else {
                    return false;
                };
                match noise {
                    Noise::Count => (written - ours).abs() <= 0.02 * ours.abs() + 0.51 * digit,
                    Noise::Size => (written / ours).ln().abs() <= 3.0f64.ln(),
                }
            })
    }
}

/// Compares the section `<!-- begin NAME -->` of a document with a table, or writes it where that is asked for.
pub fn compare(document: &str, name: &str, header: &str, rows: &[Row]) {
    let path = Path::new(roulement_tests::ROOT).join(document);
    let text = std::fs::read_to_string(&path).unwrap();
    let begin = format!("<!-- begin {name} -->\n");
    let (before, rest) = text.split_once(&begin).unwrap_or_else(|| panic!("{document} has no {begin}"));
    let (inside, after) = rest.split_once("<!-- end -->").unwrap();
    let ruler = header.split(" | ").map(|_| "---").collect::<Vec<_>>().join("|");
    let lines: Vec<String> = rows.iter().map(Row::text).collect();
    let table = format!("| {header} |\n|{ruler}|\n{}\n", lines.join("\n"));
    if std::env::var_os("ROULEMENT_RENEW").is_some() {
        std::fs::write(&path, format!("{before}{begin}{table}<!-- end -->{after}")).unwrap();
        return;
    }
    let written: Vec<&str> = inside.lines().skip(2).collect();
    let stale = rows.len() != written.len() || rows.iter().zip(&written).any(|(row, line)| !row.agrees(line));
    assert!(!stale, "{document} is stale (scripts/tables renews it):\n{inside}\nshould be\n{table}");
}

/// A number with so many digits, which may differ by a count's noise.
#[allow(dead_code)]
pub fn count(value: f64, digits: usize) -> (String, Noise) {
    (format!("{value:.digits$}"), Noise::Count)
}
