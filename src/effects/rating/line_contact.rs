//! Formulas of ISO 281 (load rating), ISO 76 and ISO/TS 16281 (life from the load of every lamina) for radial roller bearings of one row.
//!
//! The standards were not at hand: formulas are quoted from memory of their clauses and of ISO/TR 1281-1, and compared with printed values where these are known
//! (`tests/effects/line_contact.rs`).

use super::LONGEST;

/// Laminae of a roller.
pub const LAMINAE: usize = 30;
/// [-] factor of contemporary steel and manufacture (ISO 281: 2007, cylindrical roller bearings).
const MATERIAL: f64 = 1.1;
/// [-] reduction for edge loads and uneven ones that the ratings of ISO 281 have in them, and laminae have not.
const UNEVEN: f64 = 0.83;
/// [-] powers of the loads on a race that the load goes around, and on one that it stands still on.
const AROUND: f64 = 4.0;
const STILL: f64 = 4.5;

/// Ratings of a roller bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratings {
    /// \[N] basic dynamic load rating C.
    pub dynamic_load_rating: f64,
    /// \[N] basic static load rating C_0.
    pub static_load_rating: f64,
    /// \[N] ratings of a lamina on both races.
    lamina_ratings: [f64; 2],
    count: f64,
}

/// Sums over the rollers of powers of the loads of their laminae, on the inner and the outer race.
#[derive(Clone, Debug, PartialEq)]
pub struct Laminae {
    sums: [[f64; 2]; LAMINAE],
    powers: [f64; 2],
}

impl Laminae {
    /// No load yet, on races that a load goes around or stands still on.
    pub fn new(around: [bool; 2]) -> Self {
        Self { sums: [[0.0; 2]; LAMINAE], powers: around.map(|around| if around { AROUND } else { STILL }) }
    }

    /// Adds the loads \[N] of a lamina of a roller on both races.
    pub fn add(&mut self, lamina: usize, loads: [f64; 2]) {
        for (sum, (load, power)) in self.sums[lamina].iter_mut().zip(loads.into_iter().zip(self.powers)) {
            if load > 0.0 {
                *sum += load.powf(power);
            }
        }
    }
}

/// \[m] place of the middle of a lamina along a roller of a length \[m].
pub fn place_of(lamina: usize, length: f64) -> f64 {
    length * ((lamina as f64 + 0.5) / LAMINAE as f64 - 0.5)
}

/// [-] factor of the stress at the edges of a lamina.
fn edge(lamina: usize) -> f64 {
    1.0 - 0.01 / (1.985 * place_of(lamina, 1.0).abs()).ln()
}

impl Ratings {
    /// Of so many rollers with a diameter and an effective length on a pitch diameter \[m], with the cosine of the contact angle, and a dynamic load
    /// rating \[N] if it is known.
    pub fn new(
        count: usize,
        [diameter, length, pitch]: [f64; 3],
        cosine: f64,
        dynamic_load_rating: Option<f64>,
    ) -> Self {
        let gamma = diameter * cosine / pitch;
        let of_races = 1.04 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
        let factor = 207.9 * UNEVEN * gamma.powf(2.0 / 9.0) * (1.0 - gamma).powf(29.0 / 27.0)
            / (1.0 + gamma).powf(0.25)
            / (1.0 + of_races.powf(4.5)).powf(2.0 / 9.0);
        let z = count as f64;
        let own = MATERIAL
            * factor
            * (1e3 * length * cosine).powf(7.0 / 9.0)
            * z.powf(0.75)
            * (1e3 * diameter).powf(29.0 / 27.0);
        let dynamic = dynamic_load_rating.unwrap_or(own);
        let both = (1.038 / 1.04 * of_races).powf(4.5);
        let whole = [(0.378, both), (0.364, 1.0 / both)]
            .map(|(part, both)| dynamic / (UNEVEN * part * z * cosine) * (1.0 + both).powf(2.0 / 9.0));
        let share = (1.0 / LAMINAE as f64).powf(7.0 / 9.0);
        Self {
            dynamic_load_rating: dynamic,
            static_load_rating: 44e6 * (1.0 - gamma) * z * length * diameter * cosine,
            lamina_ratings: whole.map(|of| of * share),
            count: z,
        }
    }

    /// [million revolutions] reference life under loads of laminae.
    pub fn life(&self, laminae: &Laminae) -> f64 {
        let failing = laminae.sums.iter().enumerate().map(|(lamina, sums)| {
            let of = |race: usize| {
                let load = (sums[race] / self.count).powf(1.0 / laminae.powers[race]);
                (edge(lamina) * load / self.lamina_ratings[race]).powf(4.5)
            };
            of(0) + of(1)
        });
        failing.sum::<f64>().powf(-8.0 / 9.0).min(LONGEST)
    }

    /// \[N] load that gives this life.
    pub fn equivalent_load(&self, life: f64) -> f64 {
        self.dynamic_load_rating / life.powf(0.3)
    }
}
