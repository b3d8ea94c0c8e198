//! Rows of finished cases on the disk. The name of a file is a hash of all that the row follows from, so that a sweep that is
//! started again, with more cases or other ones, runs only what is not there. Files are written aside and then renamed: a file
//! of that name is whole.

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::SweepError;
use super::case::{Row, Wanted};
use crate::report::cells::{Cell, Column};

/// Form of the rows: another number where their columns mean something else.
const SCHEMA: u32 = 1;
/// [-] bytes of the hash in a name: two of 1e9 cases agree by chance with 1e-21.
const BYTES: usize = 16;

/// Directory of whole runs beside the summary.
pub const RUNS: &str = "runs";

/// A directory of rows.
#[derive(Clone, Debug)]
pub struct Store {
    directory: PathBuf,
}

impl Store {
    /// In a directory, which is made if missing.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn new(directory: &Path) -> Result<Self, SweepError> {
        let cases = directory.join("cases");
        fs::create_dir_all(&cases).map_err(|why| SweepError::file("make", &cases, &why))?;
        Ok(Self { directory: directory.to_path_buf() })
    }

    /// Name of a case: a hash of its scene's text, of the program and of what is wanted.
    pub fn name(scene: &str, wanted: &Wanted) -> String {
        let program = env!("ROULEMENT_VERSION");
        let tables = wanted.tables.as_deref().unwrap_or_default();
        let wanted = format!("{}\0{tables}", wanted.columns.join(","));
        let hash = Sha256::digest(format!("{SCHEMA}\0{program}\0{wanted}\0{scene}"));
        hash[..BYTES].iter().map(|byte| format!("{byte:02x}")).collect()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.join("cases").join(format!("{name}.csv"))
    }

    /// Is a case done?
    pub fn has(&self, name: &str) -> bool {
        self.path(name).is_file()
    }

    /// File of the whole table of a case.
    ///
    /// # Errors
    /// If its directory cannot be made.
    pub fn table(&self, name: &str, ending: &str) -> Result<PathBuf, SweepError> {
        let tables = self.directory.join("tables");
        fs::create_dir_all(&tables).map_err(|why| SweepError::file("make", &tables, &why))?;
        Ok(tables.join(format!("{name}.{ending}")))
    }

    /// Directory of the whole run of a case.
    ///
    /// # Errors
    /// If that of all runs cannot be made.
    pub fn run(&self, name: &str) -> Result<PathBuf, SweepError> {
        let runs = self.directory.join(RUNS);
        fs::create_dir_all(&runs).map_err(|why| SweepError::file("make", &runs, &why))?;
        Ok(runs.join(name))
    }

    /// Keeps the row of a case.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn put(&self, name: &str, row: &Row) -> Result<(), SweepError> {
        let path = self.path(name);
        let failed = |why: &std::io::Error| SweepError::file("write", &path, why);
        let text = to_text(row).map_err(|why| failed(&why))?;
        let aside = aside(&path);
        fs::write(&aside, text).and_then(|()| fs::rename(&aside, &path)).map_err(|why| failed(&why))
    }

    /// The row of a case; none if it is not done.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn get(&self, name: &str) -> Result<Option<Row>, SweepError> {
        let path = self.path(name);
        if !path.is_file() {
            return Ok(None);
        }
        let text = fs::read_to_string(&path);
        let row = text.and_then(|text| from_text(&text).map_err(Into::into));
        row.map(Some).map_err(|why| SweepError::file("read", &path, &why))
    }
}

/// A row as text: a line with the columns, one with the cells.
///
/// # Errors
/// If the columns are no header.
pub fn to_text(row: &Row) -> std::io::Result<String> {
    let mut table = csv::Writer::from_writer(vec![]);
    table.write_record(row.iter().map(|(column, _)| column.to_string()))?;
    table.write_record(row.iter().map(|(_, cell)| cell.to_text()))?;
    let text = table.into_inner().map_err(|why| std::io::Error::other(why.to_string()))?;
    String::from_utf8(text).map_err(std::io::Error::other)
}

/// The row of a text, to the same bits.
///
/// # Errors
/// If the text is no such row.
pub fn from_text(text: &str) -> Result<Row, csv::Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers()?.clone();
    let mut values = csv::StringRecord::new();
    reader.read_record(&mut values)?;
    let cell = |(header, text): (&str, &str)| {
        let column = Column::from_header(header);
        let cell = match column.unit {
            _ if text.is_empty() => Cell::Empty,
            Some(_) => text.parse().map_or(Cell::Empty, Cell::Number),
            None => Cell::Text(text.to_string()),
        };
        (column, cell)
    };
    Ok(header.iter().zip(&values).map(cell).collect())
}

/// A name of its own beside a file, for what is not whole yet. It keeps the ending, which says the format.
pub fn aside(path: &Path) -> PathBuf {
    use std::sync::atomic::{AtomicU64, Ordering};
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let mark = format!("part-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    path.with_file_name(format!(".{mark}-{name}"))
}
