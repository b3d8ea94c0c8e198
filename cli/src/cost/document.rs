//! A short document, written once and shown as Markdown and as HTML.

use roulement::interface::documentation::escape;
use std::fmt::Write;

/// A part of a document.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// Heading of a level, 1 the highest.
    Heading(u8, String),
    /// A paragraph.
    Text(String),
    /// A table whose first two columns are words and whose others are numbers.
    Table {
        /// Names of the columns.
        header: Vec<String>,
        /// Rows, each as long as the header.
        rows: Vec<Vec<String>>,
    },
    /// A picture beside the document.
    Figure {
        /// File name.
        file: String,
        /// Caption.
        caption: String,
    },
    /// Parts between comments with a name, by which `scripts/study` finds them.
    Section(String, Vec<Block>),
}

/// The document as Markdown.
pub fn markdown(blocks: &[Block]) -> String {
    let mut out = String::new();
    for block in blocks {
        // Writing to a string cannot fail.
        let _ = match block {
            Block::Heading(level, text) => writeln!(out, "{} {text}\n", "#".repeat(usize::from(*level))),
            Block::Text(text) => writeln!(out, "{text}\n"),
            Block::Figure { file, caption } => writeln!(out, "![{caption}]({file})\n"),
            Block::Section(name, blocks) => {
                writeln!(out, "<!-- begin {name} -->\n\n{}<!-- end -->\n", markdown(blocks))
            }
            Block::Table { header, rows } => {
                let line = |cells: &[String]| {
                    let cells: Vec<_> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
                    format!("| {} |\n", cells.join(" | "))
                };
                let ruler = (0..header.len()).map(|i| if i < 2 { "---" } else { "---:" }.to_string());
                let ruler = line(&ruler.collect::<Vec<_>>());
                let rows: String = rows.iter().map(|row| line(row)).collect();
                writeln!(out, "{}{ruler}{rows}", line(header))
            }
        };
    }
    out
}

/// The document as a page of its own.
pub fn html(title: &str, blocks: &[Block]) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
        escape(title),
        body(blocks)
    )
}

fn body(blocks: &[Block]) -> String {
    let mut out = String::new();
    for block in blocks {
        let _ = match block {
            Block::Heading(level, text) => writeln!(out, "<h{level}>{}</h{level}>", escape(text)),
            Block::Text(text) => writeln!(out, "<p>{}</p>", escape(text)),
            Block::Figure { file, caption } => {
                let (file, caption) = (escape(file), escape(caption));
                writeln!(
                    out,
                    "<figure><img src=\"{file}\" alt=\"{caption}\"><figcaption>{caption}</figcaption></figure>"
                )
            }
            Block::Section(_, blocks) => write!(out, "{}", body(blocks)),
            Block::Table { header, rows } => {
                let line = |tag: &str, cells: &[String]| {
                    let cells: String =
                        cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect();
                    format!("<tr>{cells}</tr>\n")
                };
                let rows: String = rows.iter().map(|row| line("td", row)).collect();
                writeln!(
                    out,
                    "<table>\n<thead>{}</thead>\n<tbody>\n{rows}</tbody></table>",
                    line("th", header)
                )
            }
        };
    }
    out
}

const STYLE: &str = "body { font: 15px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222 } \
    table { border-collapse: collapse; font-size: 13px; margin: 1em 0 } \
    th, td { padding: 2px 9px; border-bottom: 1px solid #ddd; text-align: right; white-space: nowrap } \
    th:nth-child(-n+2), td:nth-child(-n+2) { text-align: left } figure { margin: 1em 0 } img { max-width: 100% }";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_show_every_part() {
        let cell = |text: &str| text.to_string();
        let blocks = [
            Block::Heading(2, cell("A & B")),
            Block::Section(cell("part"), vec![Block::Text(cell("x < 1e-3"))]),
            Block::Table {
                header: vec![cell("lever"), cell("a|b"), cell("n")],
                rows: vec![vec![cell("l"), cell("s"), cell("1")]],
            },
            Block::Figure { file: cell("f.svg"), caption: cell("\"F\"") },
        ];
        assert_eq!(
            markdown(&blocks),
            "## A & B\n\n<!-- begin part -->\n\nx < 1e-3\n\n<!-- end -->\n\n| lever | a\\|b | n |\n| --- | --- | ---: |\n| l | s | 1 |\n\n![\"F\"](f.svg)\n\n"
        );
        let page = html("T", &blocks);
        for part in [
            "<h2>A &amp; B</h2>",
            "x &lt; 1e-3",
            "<th>a|b</th>",
            "<td>s</td>",
            "src=\"f.svg\" alt=\"&quot;F&quot;\"",
        ] {
            assert!(page.contains(part), "{part}\n{page}");
        }
    }
}
