//! Builds the shipped series of creep coefficients: `cargo run --release --example creep_coefficients [FILE]`, some seconds.

use std::error::Error;
use std::fs;

use roulement::kalker::Patch;
use roulement::kalker::creep_coefficients::series;
use roulement::kalker::linear::creep_matrix;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "src/kalker/creep_coefficients.bin".into());
    let terms = series(|axis_ratio, poisson_ratio| {
        let c = creep_matrix(&Patch { axis_ratio, poisson_ratio, rolling_angle: 0.0 })?;
        Ok::<_, Box<dyn Error>>([c[(0, 0)], c[(1, 1)], c[(1, 2)], c[(2, 2)]])
    })?;
    let bytes: Vec<u8> = terms.into_iter().flatten().flat_map(f64::to_le_bytes).collect();
    fs::write(&file, &bytes)?;
    println!("{file}: {} bytes", bytes.len());
    Ok(())
}
