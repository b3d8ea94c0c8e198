//! Builds the shipped table of Kalker's nonlinear theory: `cargo run --release --example kalker_table [FILE]`.

use std::error::Error;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use roulement::kalker::half_space::HalfSpaceError;
use roulement::kalker::table::{NODES, RATIOS, build, knot};

/// Nodes of one axis ratio, once they are computed.
type Slot = Option<Result<Vec<[f64; 3]>, HalfSpaceError>>;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "src/kalker/table.bin".into());
    let begin = std::time::Instant::now();
    let next = AtomicUsize::new(0);
    let slots: Mutex<Vec<Slot>> = Mutex::new(vec![None; RATIOS + 1]);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index > RATIOS {
                        return;
                    }
                    let nodes = build(knot(index));
                    println!(
                        "axis ratio {:.4} done after {:.0} s",
                        knot(index),
                        begin.elapsed().as_secs_f64()
                    );
                    slots.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(nodes);
                }
            });
        }
    });
    let mut bytes = Vec::with_capacity((RATIOS + 1) * NODES * 12);
    for slot in slots.into_inner().unwrap_or_else(PoisonError::into_inner) {
        let nodes = slot.ok_or("an axis ratio is missing")??;
        for value in nodes.into_iter().flatten() {
            bytes.write_all(&(value as f32).to_le_bytes())?;
        }
    }
    std::fs::write(&path, &bytes)?;
    println!("{path}: {} bytes, built in {:.0} s", bytes.len(), begin.elapsed().as_secs_f64());
    Ok(())
}
