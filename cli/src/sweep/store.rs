//! Rows of finished cases on the disk. The name of a file is a hash of all that the row follows from, so that a sweep that is
//! started again, with more cases or other ones, runs only what is not there. Files are written aside and then renamed: a file
//! of that name was whole. Checksums at its end tell whether it still is: what was damaged or changed since is not there.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use roulement::schema::regular;
use sha2::{Digest, Sha256};

use super::SweepError;
use super::case::{Row, Wanted};
use crate::report::cells::{Cell, Column};

/// Form of the rows: another number where their columns mean something else.
const SCHEMA: u32 = 2;
/// Version of the program, with revision and platform: another one may give other numbers.
pub const PROGRAM: &str = env!("ROULEMENT_VERSION");
/// [-] bytes of the hash in a name: two of 1e9 cases agree by chance with 1e-21.
const BYTES: usize = 16;

/// Marks before the checksum of a whole table, and before that of all lines above it, which is the last.
const OF_TABLE: &str = "# sha256 of the table ";
const OF_LINES: &str = "# sha256 of these lines ";

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
        let tables = wanted.tables.as_deref().unwrap_or_default();
        // Without growth a case has the name that it had before there was such a choice.
        let growth = if wanted.growth { "\0growth" } else { "" };
        let wanted = format!("{}\0{tables}{growth}", wanted.columns.join(","));
        let hash = Sha256::digest(format!("{SCHEMA}\0{PROGRAM}\0{wanted}\0{scene}"));
        hex(&hash[..BYTES])
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.join("cases").join(format!("{name}.csv"))
    }

    /// Is a case done, and all that is kept of it as it was written? Its whole table is in a file of this ending, if one is wanted.
    pub fn has(&self, name: &str, tables: Option<&str>) -> bool {
        let Some(lines) = self.lines(name) else { return false };
        match (lines.rsplit_once(OF_TABLE), tables) {
            (Some((_, sum)), Some(ending)) => {
                sum_of_file(&self.table_path(name, ending)).is_ok_and(|found| found == sum.trim_end())
            }
            // A case that has failed has no table.
            _ => true,
        }
    }

    /// Is there a file of a case, whatever is in it?
    pub fn has_file(&self, name: &str) -> bool {
        self.path(name).is_file()
    }

    /// Lines of a case above its checksum; none if it is not there or not as it was written.
    fn lines(&self, name: &str) -> Option<String> {
        let mut text = regular::text(&self.path(name)).ok()?;
        let (lines, sum) = text.strip_suffix('\n')?.rsplit_once(OF_LINES)?;
        let end = (sum == hex(&Sha256::digest(lines))).then_some(lines.len())?;
        text.truncate(end);
        Some(text)
    }

    fn table_path(&self, name: &str, ending: &str) -> PathBuf {
        self.directory.join("tables").join(format!("{name}.{ending}"))
    }

    /// File of the whole table of a case.
    ///
    /// # Errors
    /// If its directory cannot be made.
    pub fn table(&self, name: &str, ending: &str) -> Result<PathBuf, SweepError> {
        let tables = self.directory.join("tables");
        fs::create_dir_all(&tables).map_err(|why| SweepError::file("make", &tables, &why))?;
        Ok(self.table_path(name, ending))
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

    /// Keeps the row of a case, and the checksum of its whole table, if it has one.
    ///
    /// # Errors
    /// If the file cannot be written, or the table not be read.
    pub fn put(&self, name: &str, row: &Row, table: Option<&Path>) -> Result<(), SweepError> {
        let path = self.path(name);
        let failed = |why: &std::io::Error| SweepError::file("write", &path, why);
        let mut text = to_text(row).map_err(|why| failed(&why))?;
        if let Some(table) = table {
            let sum = sum_of_file(table).map_err(|why| SweepError::file("read", table, &why))?;
            text += &format!("{OF_TABLE}{sum}\n");
        }
        text += &format!("{OF_LINES}{}\n", hex(&Sha256::digest(&text)));
        let aside = aside(&path);
        fs::write(&aside, text).and_then(|()| fs::rename(&aside, &path)).map_err(|why| failed(&why))
    }

    /// Takes a finished case out of another store: its row and table where they are wanted, and its run, if it is kept there and not here.
    /// Files stay in the other store, too; where the disc can, they are one file with two names.
    ///
    /// # Errors
    /// If files cannot be written.
    pub fn take(
        &self,
        from: &Self,
        name: &str,
        tables: Option<&str>,
        with_row: bool,
    ) -> Result<(), SweepError> {
        if with_row {
            // The row last: where it is, all is there. A case that has failed has no table.
            if let Some(ending) = tables.filter(|ending| from.table_path(name, ending).is_file()) {
                link(&from.table_path(name, ending), &self.table(name, ending)?)?;
            }
            link(&from.path(name), &self.path(name))?;
        }
        let run = from.directory.join(RUNS).join(name);
        if run.is_dir() {
            let kept = self.run(name)?;
            if !kept.is_dir() {
                let part = aside(&kept);
                link_all(&run, &part)?;
                fs::rename(&part, &kept).map_err(|why| SweepError::file("write", &kept, &why))?;
            }
        }
        Ok(())
    }

    /// The row of a case; none if it is not done, or its file not as it was written.
    pub fn get(&self, name: &str) -> Option<Row> {
        from_text(&self.lines(name)?).ok()
    }
}

/// Gives a file another name, in the place of what is there; copies it where the disc knows one name of a file alone.
fn link(from: &Path, to: &Path) -> Result<(), SweepError> {
    let part = aside(to);
    let linked = fs::hard_link(from, &part).or_else(|_| fs::copy(from, &part).map(drop));
    linked.and_then(|()| fs::rename(&part, to)).map_err(|why| SweepError::file("write", to, &why))
}

/// The same for all files of a folder.
fn link_all(from: &Path, to: &Path) -> Result<(), SweepError> {
    let failed = |why: std::io::Error| SweepError::file("copy", from, &why);
    fs::create_dir_all(to).map_err(failed)?;
    for entry in fs::read_dir(from).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            link_all(&path, &to)?;
        } else {
            link(&path, &to)?;
        }
    }
    Ok(())
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Checksum of a file of any size.
fn sum_of_file(path: &Path) -> std::io::Result<String> {
    let mut file = regular::open(path)?;
    let mut hash = Sha256::new();
    let mut part = vec![0; 1 << 16];
    loop {
        match file.read(&mut part)? {
            0 => return Ok(hex(&hash.finalize())),
            count => hash.update(&part[..count]),
        }
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

/// A name of its own beside a file, for what is not whole yet. It keeps the ending, which says the format. Processes of several machines
/// may have the same number on a shared disc: each has a mark of chance, too.
pub fn aside(path: &Path) -> PathBuf {
    use std::hash::{BuildHasher, RandomState};
    use std::sync::LazyLock;
    use std::sync::atomic::{AtomicU64, Ordering};
    static COUNT: AtomicU64 = AtomicU64::new(0);
    // In a browser there is one process without a number.
    let process = || if cfg!(target_family = "wasm") { 0 } else { std::process::id() };
    static CHANCE: LazyLock<u64> = LazyLock::new(|| RandomState::new().hash_one("part"));
    let mark = format!("part-{}-{:x}-{}", process(), *CHANCE, COUNT.fetch_add(1, Ordering::Relaxed));
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    path.with_file_name(format!(".{mark}-{name}"))
}
