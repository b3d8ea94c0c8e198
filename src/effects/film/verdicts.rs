//! What oil does, or would do, to a bearing: films over roughness, and rolling resistance.

use super::oil::Oil;
use super::section::Section;
use crate::contact::film::thickness::Ellipse;
use crate::contact::film::{Film, Loading, RacewayFilm, Supply};
use crate::effects::estimate::{ContactEstimate, Estimate, Standing, Verdict, digits};
use crate::schema::units::{Celsius, Density, Viscosity};

/// [-] film over roughness below which contacts are dry but for their boundary layers, and above which a film carries them.
const MIXED: [f64; 2] = [1.0, 3.0];
/// The oil that the estimate is for where the scene has none: a film is thick where it is cold.
const USUAL: (f64, f64) = (68.0, 40.0);

/// An oil at its contacts, flooded; isothermal where it is not the scene's own.
struct Candidate {
    name: String,
    section: Section,
    viscosity: f64,
}

impl Candidate {
    /// That of a section; the usual one, or one of a dynamic viscosity [Pa s] that is known, without it.
    fn new(section: Option<&Section>, known: Option<f64>) -> Self {
        let section = section.cloned().unwrap_or_else(|| {
            let cool = Section { inlet_heating: false, ..Section::default() };
            match known {
                Some(viscosity) => Section { viscosity: Some(Viscosity(viscosity)), ..cool },
                None => Section {
                    iso_vg: Some(USUAL.0),
                    temperature: Some(Celsius(USUAL.1)),
                    // 58.5 mPa s, as the reference data have it.
                    density: Density(860.0),
                    ..cool
                },
            }
        });
        let (oil, temperature) = (Oil::of(&section), section.oil_temperature());
        Self { name: oil.name(temperature), viscosity: oil.viscosity(temperature), section }
    }

    /// A quantity of the film of a contact.
    fn of<T>(
        &self,
        contact: &ContactEstimate,
        modulus: f64,
        get: impl FnOnce(&Film<'_>, &Loading<f64>) -> T,
    ) -> T {
        let curvature = contact.curvatures[0];
        let ellipse = Ellipse::new(contact.semi_axes, contact.load, modulus, curvature);
        let raceway = RacewayFilm::new(self.section.lubricant(), modulus, ellipse);
        let supply = Supply { viscosity: self.viscosity, lubrication: 1.0, replenishment: 1.0 };
        let loading = Loading {
            load: contact.load,
            speed: contact.rolling_speed,
            slip: 1e-3 * contact.rolling_speed,
            curvature,
            area: std::f64::consts::PI * contact.semi_axes[0] * contact.semi_axes[1],
        };
        get(&Film::new(&raceway, supply, 0.0), &loading)
    }
}

/// What the oil of a section does; of the usual oil without one.
pub fn of(section: Option<&Section>, estimate: &Estimate) -> Vec<Verdict> {
    let oil = Candidate::new(section, estimate.viscosity);
    let standing = if section.is_some() { Standing::On } else { Standing::Off };
    let rolls = estimate.contacts.iter().filter(|contact| contact.rolling_speed > 0.0);
    let power: f64 = rolls
        .clone()
        .map(|contact| {
            oil.of(contact, estimate.modulus, |film, loading| {
                2.0 * film.forces(loading).rolling_force * loading.speed
            })
        })
        .sum();
    let inner = rolls.filter(|contact| contact.race == 0);
    let most = inner.max_by(|a, b| a.load.total_cmp(&b.load));
    let share = |film: &Film<'_>, loading: &Loading<f64>| film.ratio(loading);
    let ratio = most.map_or(0.0, |contact| oil.of(contact, estimate.modulus, share));
    let name = &oil.name;
    let write = "[film] with iso_vg and temperature of the oil";
    let verdict = |subject, share, sentence| Verdict {
        key: Some("film"),
        ..Verdict::new(subject, standing, share, sentence, write)
    };
    let regime = match ratio {
        _ if ratio < MIXED[0] => "dry friction fits",
        _ if ratio < MIXED[1] => "mixed: the film takes part of the load",
        _ => "a film carries the balls: friction is the film's, not the dry one",
    };
    let film = format!(
        "film {} times the roughness of {} um ({name}): {regime}",
        digits(ratio),
        digits(oil.section.roughness.0 * 1e6)
    );
    let dry = estimate.friction_power();
    let share = power / dry.max(f64::MIN_POSITIVE);
    let resistance = format!(
        "{} W ({name}), {} times the dry friction power of {} W",
        digits(power),
        digits(share),
        digits(dry)
    );
    let mut verdicts = vec![verdict("film", (ratio, MIXED[0]), film)];
    if dry > 0.0 {
        verdicts.push(verdict("rolling resistance", (share, estimate.threshold), resistance));
    }
    verdicts
}
