//! Solves Kalker's nonlinear problem in polynomials for the rolling contacts of a case table, for timing and for counting
//! instructions: `polynomial_solves DEGREE cold|warm COUNT CASES.csv`. A warm solve starts from creepages 1 % smaller. It
//! prints mean microseconds and iterations of a solve.

use std::error::Error;
use std::time::{Duration, Instant};

use roulement::analysis::single_contact::{RollingContact, ScaledContact};
use roulement::kalker::nonlinear::Kalker;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [degree, start, count, file] = &arguments[..] else {
        return Err("usage: polynomial_solves DEGREE cold|warm COUNT CASES.csv".into());
    };
    let (degree, count): (usize, u32) = (degree.parse()?, count.parse()?);
    let (mut time, mut iterations, mut solves) = (Duration::ZERO, 0, 0);
    for contact in csv::Reader::from_path(file)?.deserialize() {
        let contact: RollingContact = contact?;
        let ScaledContact { patch, creepage } = contact.scaled()?;
        let kalker = Kalker::new(patch, degree)?;
        let nearby = match start.as_str() {
            "warm" => Some(kalker.solve(&creepage.times(0.99), None)?),
            _ => None,
        };
        let start = nearby.as_ref().map(|solution| solution.coefficients.as_slice());
        let begin = Instant::now();
        for _ in 0..count {
            iterations += kalker.solve(&creepage, start)?.iterations;
            solves += 1;
        }
        time += begin.elapsed();
    }
    let per_solve = 1.0 / f64::from(solves.max(1));
    println!("{:.1} {:.1}", time.as_secs_f64() * 1e6 * per_solve, f64::from(iterations) * per_solve);
    Ok(())
}
