//! Builds the shipped table of Kalker's nonlinear theory: `cargo run --release --example kalker_table [FILE]`.
//!
//! It takes two to three hours on two cores. Each axis ratio has a file of its own beside FILE, so that an interrupted run
//! goes on where it was.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use roulement::kalker::packed::packed;
use roulement::kalker::table::{GRID, RATIOS, axis_ratio};
use roulement::kalker::table_nodes::build;

fn part(file: &str, index: usize) -> PathBuf {
    PathBuf::from(format!("{file}.{index}"))
}

/// Builds one axis ratio unless its file is there.
fn build_part(file: &str, index: usize, begin: Instant) -> Result<(), String> {
    let path = part(file, index);
    if path.exists() {
        return Ok(());
    }
    let nodes = build(axis_ratio(index)).map_err(|why| why.to_string())?;
    let bytes: Vec<u8> = nodes.into_iter().flatten().flat_map(|value| (value as f32).to_le_bytes()).collect();
    fs::write(&path, bytes).map_err(|why| format!("{}: {why}", path.display()))?;
    println!("axis ratio {:.4} done after {:.0} s", axis_ratio(index), begin.elapsed().as_secs_f64());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "src/kalker/table.bin".into());
    let begin = Instant::now();
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let work = || -> Result<(), String> {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index > RATIOS {
                    return Ok(());
                }
                build_part(&file, index, begin)?;
            }
        };
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        handles.into_iter().try_for_each(|handle| handle.join().map_err(|_| "a thread failed".to_string())?)
    })?;
    let mut numbers = vec![];
    for index in 0..=RATIOS {
        let bytes = fs::read(part(&file, index))?;
        numbers.extend(bytes.chunks_exact(4).map(|one| f32::from_le_bytes([one[0], one[1], one[2], one[3]])));
    }
    let bytes = packed(&numbers, GRID).ok_or("a number of the table is larger than 16")?;
    fs::write(&file, &bytes)?;
    for index in 0..=RATIOS {
        fs::remove_file(part(&file, index))?;
    }
    println!("{file}: {} bytes, built in {:.0} s", bytes.len(), begin.elapsed().as_secs_f64());
    Ok(())
}
