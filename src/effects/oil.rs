//! What oil would do to a bearing: film over roughness, and hydrodynamic rolling resistance. Estimates alone: friction is that of dry
//! contacts.

use std::f64::consts::PI;

use super::estimate::{ContactEstimate, Estimate, Standing, Verdict, digits};

/// An oil, and the roughness that it has to part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oil {
    /// Its name.
    pub name: &'static str,
    /// [Pa s] dynamic viscosity.
    pub viscosity: f64,
    /// [1/Pa] growth of viscosity with pressure.
    pub pressure_viscosity: f64,
    /// \[m] roughness of ball and race together, root mean square.
    pub roughness: f64,
}

/// A mineral oil of ISO VG 68 at 40 degC, 880 kg/m3, between ground and polished surfaces. At 70 degC its viscosity is a third:
/// films and rolling resistance are then half as large.
pub const USUAL: Oil =
    Oil { name: "ISO VG 68 at 40 degC", viscosity: 0.0585, pressure_viscosity: 2.2e-8, roughness: 0.1e-6 };
/// [kg/m3] density of mineral oil.
pub const DENSITY: f64 = 880.0;
/// [-] film over roughness below which contacts are dry but for their boundary layers, and above which a film carries them.
const MIXED: [f64; 2] = [1.0, 3.0];

impl Oil {
    /// A mineral oil of a kinematic viscosity [m2/s] at running temperature.
    pub fn of_kinematic(viscosity: f64) -> Self {
        Self { name: "oil of rating.viscosity", viscosity: viscosity * DENSITY, ..USUAL }
    }

    /// \[m] least film in a contact, isothermal and flooded (Hamrock and Dowson 1977); `modulus` \[Pa] is E'.
    pub fn least_film(&self, contact: &ContactEstimate, modulus: f64) -> f64 {
        let radius = 1.0 / contact.curvatures[0];
        let speed = self.viscosity * contact.rolling_speed / (modulus * radius);
        let load = contact.load / (modulus * radius * radius);
        let ellipticity = contact.semi_axes[1] / contact.semi_axes[0];
        let shape = 1.0 - (-0.68 * ellipticity).exp();
        let stiffening = (self.pressure_viscosity * modulus).powf(0.49);
        3.63 * speed.powf(0.68) * stiffening * load.powf(-0.073) * shape * radius
    }

    /// \[N] hydrodynamic rolling force on each surface of a contact (Biboulet and Houpert 2010, part 2, eq. 32), isothermal and
    /// flooded; its power is twice this times the rolling speed.
    pub fn rolling_force(&self, contact: &ContactEstimate, modulus: f64) -> f64 {
        let radius = 1.0 / contact.curvatures[0];
        let [along, across] = contact.semi_axes;
        let speed = 2.0 * self.viscosity * contact.rolling_speed / (modulus * radius);
        let load = contact.load / (modulus * radius * radius);
        let pressure = 1.5 * contact.load / (PI * along * across);
        // Half width of the contact over that of a line contact of the same peak pressure, over a quarter of pi.
        let beta = along * modulus / (PI * radius * pressure);
        let ratio = along / across;
        let share = beta.powf(0.25) * ratio * load / speed.powf(0.75);
        let elastic = 1.8 * beta.powf(-0.25);
        let rigid = 0.77 * beta.powf(-1.0 / 3.0) * ratio.powf(0.12) * speed.powf(-1.0 / 12.0);
        let size = modulus * radius * 2.0 * across * speed.powf(0.75);
        size * ((rigid - elastic) / (1.0 + share / 6.6) + elastic)
    }

    /// \[W] power of rolling resistance in all contacts.
    pub fn rolling_power(&self, estimate: &Estimate) -> f64 {
        let of = |contact: &ContactEstimate| {
            2.0 * self.rolling_force(contact, estimate.modulus) * contact.rolling_speed
        };
        estimate.contacts.iter().filter(|contact| contact.rolling_speed > 0.0).map(of).sum()
    }

    /// [-] film over roughness of the ball with the largest load, at the inner race, where films are thinner.
    pub fn film_ratio(&self, estimate: &Estimate) -> f64 {
        let inner = estimate.contacts.iter().filter(|contact| contact.race == 0);
        let most = inner.max_by(|a, b| a.load.total_cmp(&b.load));
        most.map_or(0.0, |contact| self.least_film(contact, estimate.modulus) / self.roughness)
    }

    /// What the oil would do.
    pub fn verdicts(&self, estimate: &Estimate) -> Vec<Verdict> {
        let Self { name, roughness, .. } = self;
        let verdict = |subject, share, sentence| {
            let write = "not simulated: friction is dry; friction.ball_race stands for all of it";
            Verdict::new(subject, Standing::Missing, share, sentence, write)
        };
        let ratio = self.film_ratio(estimate);
        let regime = match ratio {
            _ if ratio < MIXED[0] => "dry friction fits",
            _ if ratio < MIXED[1] => "mixed: the film takes part of the load",
            _ => "a film carries the balls: friction is the film's, not the dry one",
        };
        let film = format!(
            "film {} times the roughness of {} um ({name}): {regime}",
            digits(ratio),
            digits(roughness * 1e6)
        );
        let (power, dry) = (self.rolling_power(estimate), estimate.friction_power());
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
}
