//! Rolling contacts in oblique directions by the half-space solver, which the net of oblique rolling learns from. `scripts/oblique-net` calls it.
//!
//! `oblique_contacts solve SEED COUNT FILE` writes a contact in each row of FILE: axis ratio, direction of rolling \[rad], creepages along x and
//! y and spin in Kalker's scale, forces over mu N and moment over mu N c. It depends on the seed and the number of the row alone, so that an
//! interrupted run goes on where it was.
//!
//! `oblique_contacts see FILE` prints what the net sees of each: its arguments and the factor of its results, what forces over mu N and the
//! moment over its limit lack in the mixture of both tables, the limit over mu N c; and what each of the three does work on and the power.

use std::error::Error;
use std::f64::consts::TAU;
use std::fs::{self, OpenOptions};
use std::io::{BufRead, BufReader, Write};

use roulement::contact::creep::{Creepage, Law, LinearTheory};
use roulement::contact::oblique::{Across, Exchanged, exchanged};
use roulement::kalker::half_space::extrapolated;
use roulement::kalker::linear::Scales;
use roulement::kalker::oblique_net::ObliqueNet;
use roulement::kalker::table::CreepTable;
use roulement::kalker::{LinearError, Patch, ScaledCreepage};

/// Cells of the coarser of two grids.
const CELLS: usize = 24;
/// Poisson's ratio of the table.
const POISSON: f64 = 0.3;

/// Random numbers in [0, 1) of a seed and a row (splitmix64, Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn new(seed: u64, row: u64) -> Self {
        let mut random = Self(seed);
        let start = random.bits();
        Self(start ^ row.wrapping_mul(0xd1b5_4a32_d192_ed03))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }
}

/// The contact of a row. Three of four ellipses are narrow. Half of the directions are even between 2 and 88 degrees, the others between the
/// same ends where the ellipse is drawn out to a circle: for narrow ellipses most of these are close to 90 degrees.
fn contact(random: &mut Random) -> (Patch, ScaledCreepage) {
    let narrow = random.unit() < 0.75;
    let (low, high) = if narrow { (0.05, 0.3) } else { (0.3, 1.0) };
    let axis_ratio = random.logarithmic(low, high);
    let ends = [2f64, 88.0].map(f64::to_radians);
    let rolling_angle = if random.unit() < 0.5 {
        random.between(ends[0], ends[1])
    } else {
        let drawn = ends.map(|angle| (axis_ratio * angle.tan()).atan());
        (random.between(drawn[0], drawn[1]).tan() / axis_ratio).atan()
    };
    let (sin, cos) = random.between(0.0, TAU).sin_cos();
    let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
    let kind = random.unit();
    let (creep, spin) = if kind < 0.5 {
        (random.logarithmic(0.05, 12.0), random.logarithmic(0.1, 20.0))
    } else if kind < 0.8 {
        let (size, height) = (random.logarithmic(0.05, 60.0), random.unit());
        (size * (1.0 - height * height).sqrt(), size * height)
    } else {
        // where the force across rolling that spin makes has its peak
        (random.logarithmic(0.02, 2.0), random.logarithmic(0.1, 5.0))
    };
    let creepage = ScaledCreepage { x: creep * cos, y: creep * sin, spin: sign * spin, curvature: 0.0 };
    (Patch { axis_ratio, poisson_ratio: POISSON, rolling_angle }, creepage)
}

/// Solves the contacts of a seed that FILE has not.
fn solve(seed: u64, count: u64, file: &str) -> Result<(), Box<dyn Error>> {
    let mut rows = OpenOptions::new().create(true).append(true).read(true).open(file)?;
    let done = BufReader::new(&rows).lines().count() as u64;
    for row in done..count {
        let (patch, creepage) = contact(&mut Random::new(seed, row));
        let forces = extrapolated(&patch, &creepage, CELLS)?;
        let ScaledCreepage { x, y, spin, .. } = creepage;
        let numbers = [patch.axis_ratio, patch.rolling_angle, x, y, spin, forces.fx, forces.fy, forces.mz];
        writeln!(rows, "{}", numbers.map(|number| format!("{number:.9e}")).join(","))?;
    }
    Ok(())
}

/// What the net sees of a contact, and what it should answer.
fn seen(row: &[f64; 8]) -> Result<Vec<f64>, LinearError> {
    let [axis_ratio, angle, x, y, spin, fx, fy, mz] = *row;
    let patch = Patch { axis_ratio, poisson_ratio: POISSON, rolling_angle: 0.0 };
    let there = exchanged(&patch);
    let tables = [CreepTable::new(&patch)?, CreepTable::new(&there)?];
    let Scales { c11, c22, c23, c33, moment } = Scales::new(&patch)?;
    let (sine, cosine) = angle.sin_cos();
    let theory = LinearTheory {
        longitudinal: c11,
        lateral: c22,
        coupling: c23 * cosine,
        spin: c33,
        friction_limit: 1.0,
        moment_limit: moment,
        mean_semi_axis: 1.0,
        half_width: 1.0 / axis_ratio.sqrt(),
    };
    let creepage = Creepage { longitudinal: x, lateral: y, spin, curvature: None };
    let [along, across] = tables.each_ref().map(Law::Table);
    let forces = theory.forces(along, &creepage);
    let exchanged = Exchanged::new(&patch)?;
    let mixed = Across { exchanged: &exchanged, law: across }.mixed(&forces, &theory, sine, &creepage);
    let q = [c11 * x, c22 * y, c33 / moment * spin];
    let features = ObliqueNet::new(&patch)?.features([q[0], q[1], q[2], cosine, sine]);
    let lacking = [fx - mixed.longitudinal, fy - mixed.lateral, (mz - mixed.spin_moment) / moment];
    let powers = [x, y, spin * moment, x * fx + y * fy + spin * mz];
    Ok([&features.odd[..], &features.even, &features.factors[..1], &lacking, &[moment], &powers].concat())
}

/// Prints what the net sees of the contacts of FILE, and what it should answer.
fn see(file: &str) -> Result<(), Box<dyn Error>> {
    for line in fs::read_to_string(file)?.lines() {
        let mut row = [0.0; 8];
        for (number, text) in row.iter_mut().zip(line.split(',')) {
            *number = text.parse()?;
        }
        println!(
            "{}",
            seen(&row)?.iter().map(|number| format!("{number:.9e}")).collect::<Vec<_>>().join(",")
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["solve", seed, count, file] => solve(seed.parse()?, count.parse()?, file),
        ["see", file] => see(file),
        _ => Err("usage: oblique_contacts solve SEED COUNT FILE, or oblique_contacts see FILE".into()),
    }
}
