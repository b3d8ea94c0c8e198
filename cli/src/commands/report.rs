//! `roulement report`: one page of a run, of several runs, or of a sweep.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use roulement_cli::page::grid::{Grid, thinned, without};
use roulement_cli::page::{fields, html, record, sweep, table};
use roulement_cli::sweep::store::RUNS;
use serde_json::{Value, json};

use super::{say, tell};

/// Options of `roulement report`.
#[derive(Args)]
pub struct Options {
    /// Directories that `roulement run` or `roulement sweep` wrote; several are put side by side.
    #[arg(required = true)]
    results: Vec<PathBuf>,
    /// Page to write.
    #[arg(short, long, default_value = "report.html")]
    output: PathBuf,
    /// Columns of the tables that are taken: names with `*` for any characters; all if not given.
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Rows of a table at most; as many as there is room for if not given.
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..))]
    rows: Option<u32>,
    /// Tables of `roulement field`, whose contacts are shown with those at the end of the first bearing.
    #[arg(long)]
    field: Vec<PathBuf>,
}

/// [byte] pages beyond this are slow to send and to open.
const LARGE: usize = 2_000_000;
/// [-] rows of motion that a shaft and the bearings on it share; the record of each has up to 1025.
const HISTORY: usize = 600;
/// [-] rows of each of them at least.
const LEAST: usize = 33;

/// Writes the page.
///
/// # Errors
/// If a directory has no results, or the page cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let mut runs: Vec<Value> = vec![];
    let mut sweeps = vec![];
    let mut titles = vec![];
    for directory in &options.results {
        if is_sweep(directory) {
            sweeps.push(of_sweep(directory, options)?);
        } else {
            let machine = of_machine(directory, options)?;
            // A shaft is what its bearings are a part of.
            titles.push(title(&machine[0]).to_string());
            runs.extend(machine);
        }
    }
    for path in &options.field {
        let of_bearing = runs.iter_mut().find(|run| run["shaft"].is_null());
        let run = of_bearing.ok_or("--field: there is no run that its contacts could belong to")?;
        let more = fields::read(path)?;
        if let Some(list) = run["fields"].as_array_mut() {
            list.extend(more);
        }
    }
    titles.extend(sweeps.iter().map(|sweep| title(sweep).to_string()));
    let title = titles.join(" | ");
    let words: Vec<&str> = runs.iter().filter_map(|run| run["summary_text"].as_str()).collect();
    let words = words.join("\n");
    let page = html::page(&title, &words, &json!({ "runs": runs, "sweeps": sweeps }));
    if page.len() > LARGE {
        tell([format!(
            "the page has {:.1} MB; --columns and --rows make it smaller",
            page.len() as f64 * 1e-6
        )]);
    }
    fs::write(&options.output, page)
        .map_err(|why| format!("cannot write {}: {why}", options.output.display()))?;
    Ok(say(&format!("{}\n", options.output.display()))?)
}

fn is_sweep(directory: &Path) -> bool {
    directory.join(sweep::FILE).is_file() && !directory.join(record::FILE).is_file()
}

/// Last part of a path.
fn name_of(directory: &Path) -> String {
    directory.file_name().unwrap_or(directory.as_os_str()).to_string_lossy().into_owned()
}

fn title(part: &Value) -> &str {
    let of = |key: &str| part[key].as_str().filter(|text| !text.is_empty());
    of("title").or(of("name")).unwrap_or("ball bearing")
}

/// Summary of a sweep, its tables, and the whole runs that it has kept.
fn of_sweep(directory: &Path, options: &Options) -> Result<Value, Box<dyn Error>> {
    let mut sweep = sweep::read(directory)?;
    sweep["name"] = name_of(directory).into();
    let mut runs = serde_json::Map::new();
    for (case, file) in sweep::files(&sweep) {
        let kept = directory.join(RUNS).join(&file);
        if kept.is_dir() {
            let mut run = of_machine(&kept, options)?.remove(0);
            run["name"] = format!("case {case}").into();
            runs.insert(file, run);
        }
    }
    sweep["runs"] = runs.into();
    Ok(sweep)
}

/// A run of a bearing; or that of a shaft, then of every bearing on it.
fn of_machine(directory: &Path, options: &Options) -> Result<Vec<Value>, Box<dyn Error>> {
    let record = record::read(directory)?;
    let bearings = record::bearings(&record).unwrap_or_default();
    let share = 1 + bearings.len();
    let mut runs = vec![of_run(directory, record, options, share)?];
    for name in &bearings {
        let directory = directory.join(name);
        runs.push(of_run(&directory, record::read(&directory)?, options, share)?);
    }
    Ok(runs)
}

/// Record and table of a bearing or a shaft; so many runs share the room of one.
fn of_run(
    directory: &Path,
    mut record: Value,
    options: &Options,
    share: usize,
) -> Result<Value, Box<dyn Error>> {
    record["name"] = name_of(directory).into();
    let is_shaft = record::bearings(&record).is_some();
    let path = directory.join(if is_shaft { "shaft.csv" } else { "results.csv" });
    if !path.is_file() {
        tell([format!("{} is not there: the page has what the record holds", path.display())]);
        record["tables"] = json!([]);
        return Ok(record);
    }
    // Columns that are chosen are those of bearings.
    let columns = if is_shaft { vec![] } else { options.columns.clone() };
    let choice = table::Choice { columns, rows: options.rows.map(|rows| rows as usize), share };
    let read = table::read(&path, &choice)?;
    // What the table has at the same times is not written twice.
    if let [grid] = read.grids.as_slice()
        && Some(grid.rows() as u64) == record["history"]["rows"].as_u64()
    {
        let names: Vec<String> = grid.names().map(str::to_string).collect();
        record["history"] = without(&record["history"], &names);
    }
    if share > 1 {
        record["history"] = thinned(&record["history"], (HISTORY / share).max(LEAST));
    }
    record["table_rows"] = read.rows.into();
    record["strides"] = read.strides.into();
    record["tables"] = read.grids.iter().map(Grid::to_json).collect();
    Ok(record)
}
