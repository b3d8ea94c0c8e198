//! Notes for the reader of a scene's results: defaults that were taken, and numbers that are allowed but make no sense
//! for a ball bearing.

use toml::Table;

use super::Scene;
use super::typical::unusual;
use crate::effects::estimate::Outline;
use crate::schema::numbers::four;

/// [m rad/s] speed times bore, DN = 3e6 mm/min, beyond which no ball bearing is known to run: bearings of 120 mm did at 25,000 rpm
/// (Bamberger, Zaretsky and Signer 1976).
const FASTEST: f64 = 3e6 * 1e-3 * std::f64::consts::TAU / 60.0;
/// [-] by how much a usual bore may be wrong.
const BORE_SPREAD: f64 = 1.05;
/// \[Pa] pressure at which balls leave marks of a ten thousandth of their diameter: the static load rating of ISO 76.
const STATIC_RATING: f64 = 4200e6;
/// [-] by how much two viscosities of one oil may differ, as data sheets round them.
const SAME_OIL: f64 = 0.05;
/// [-] friction coefficient above that of dry steel on steel.
const ROUGHEST: f64 = 0.6;

impl Scene {
    /// Notes and warnings about the scene as it is written, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = self.doubts();
        notes.extend(unusual(&self.source));
        notes
    }

    /// The same, but for single numbers: those of a machine's bearing stand in the file of the machine.
    pub(super) fn doubts(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(note) = self.default_conformities() {
            notes.push(note);
        }
        let speed = self.fastest();
        let (bore, about, spread) = match self.bore() {
            Some(bore) => (bore, "", 1.0),
            None => {
                let Outline { bore, .. } =
                    Outline::usual(self.bearing.pitch_diameter.0, self.bearing.ball_diameter.0);
                (bore, "about ", BORE_SPREAD)
            }
        };
        if speed * bore > spread * FASTEST {
            notes.push(format!(
                "warning: DN = {:.2e} mm/min ({:.0} rpm on a bore of {about}{:.1} mm): above 3e6 no ball bearing is \
                 known to run; are load.inner_speed and load.outer_speed in the unit that you mean?",
                speed * bore / FASTEST * 3e6,
                speed * 30.0 / std::f64::consts::PI,
                bore * 1e3
            ));
        }
        let friction = self.friction.ball_race.values().into_iter().fold(0.0, f64::max);
        if friction > ROUGHEST {
            notes.push(format!(
                "warning: friction.ball_race = {friction} is above that of dry steel; lubricated contacts have 0.03 to 0.12"
            ));
        }
        notes.extend(self.two_oils());
        notes
    }

    /// A warning where films and lives are of different oils.
    fn two_oils(&self) -> Option<String> {
        let rated = self.effects.rating.section.as_ref()?.viscosity?.0;
        let oil = self.effects.film.kinematic_viscosity()?;
        ((rated / oil - 1.0).abs() > SAME_OIL).then(|| {
            format!(
                "warning: rating.viscosity = {} mm2/s is not that of the oil of [film], {} mm2/s: life and films are of different oils; \
                 without rating.viscosity the life takes the oil of [film]",
                four(&(rated * 1e6)),
                four(&(oil * 1e6))
            )
        })
    }

    /// A warning where balls are pressed on the races harder than they stand \[Pa].
    pub fn pressure_note(&self, peak_pressure: f64) -> Option<String> {
        (peak_pressure > STATIC_RATING).then(|| {
            format!(
                "warning: the largest contact pressure is {:.0} MPa: above 4200 MPa (static load rating, ISO 76) balls leave \
                 lasting marks in the races; is the load in the unit that you mean?",
                peak_pressure * 1e-6
            )
        })
    }

    /// \[m] the bore, where the scene has it.
    fn bore(&self) -> Option<f64> {
        let of_film = self.effects.film.section.as_ref().and_then(|film| film.bore.as_ref());
        let of_growth = self.effects.growth.section.as_ref().and_then(|growth| growth.shaft.as_ref());
        of_film.map(|bore| bore.0).or(of_growth.map(|shaft| shaft.diameter.0))
    }

    fn default_conformities(&self) -> Option<String> {
        let table: Table = toml::from_str(&self.source).ok()?;
        let bearing = table.get("bearing")?.as_table()?;
        let of_race = [
            ("inner_conformity", self.bearing.inner_conformity),
            ("outer_conformity", self.bearing.outer_conformity),
        ];
        let taken: Vec<String> = of_race
            .iter()
            .filter(|(key, _)| !bearing.contains_key(*key))
            .map(|(key, value)| format!("bearing.{key} = {value}"))
            .collect();
        let keys = taken.join(" and ");
        (!taken.is_empty())
            .then(|| format!("note: taken by default: {keys} (groove radius over ball diameter)"))
    }

    /// [rad/s] largest relative speed of the races.
    fn fastest(&self) -> f64 {
        let differences = self.load.inner_speed.values_of_difference(&self.load.outer_speed);
        differences.into_iter().map(f64::abs).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRUST: &str = include_str!("../../scenes/thrust.toml");

    fn notes(changes: &[(&str, &str)]) -> Vec<String> {
        Scene::edited(THRUST, changes.iter().copied()).unwrap().notes()
    }

    #[test]
    fn closed_form_speeds_beyond_any_bearing_are_warned_of() {
        assert_eq!(notes(&[]), Vec::<String>::new());
        // 46 mm less 1.65 balls of 9.525 mm: 30.3 mm, of which 3e6 mm/min and a spread of 5 % are 104,000 rpm.
        assert_eq!(notes(&[("load.inner_speed", "\"103900 rpm\"")]), Vec::<String>::new());
        let fast = notes(&[("load.inner_speed", "\"104100 rpm\"")]);
        assert!(
            fast.len() == 1 && fast[0].contains("DN = 3.15e6") && fast[0].contains("104100 rpm"),
            "{fast:?}"
        );
        // A bore that is given is taken as it is: 30 mm.
        let given =
            ("film", "{ iso_vg = 68, temperature = \"70 degC\", bore = \"30 mm\", outside = \"62 mm\" }");
        assert_eq!(notes(&[given, ("load.inner_speed", "\"99900 rpm\"")]), Vec::<String>::new());
        let fast = notes(&[given, ("load.inner_speed", "\"100100 rpm\"")]);
        assert!(fast.len() == 1 && fast[0].contains("bore of 30.0 mm"), "{fast:?}");
        // Relative speeds count, at any time.
        let both = ("load.outer_speed", "\"104100 rpm\"");
        assert_eq!(notes(&[("load.inner_speed", "\"104100 rpm\""), both]), Vec::<String>::new());
        let ramp = notes(&[("load.outer_speed", "[[0, 0], [\"1 ms\", \"-110000 rpm\"], [\"2 ms\", 0]]")]);
        assert!(ramp.len() == 1 && ramp[0].contains("116000 rpm"), "{ramp:?}");
    }

    #[test]
    fn conformities_that_are_left_out_have_defaults_and_a_note() {
        let changes = [("bearing.inner_conformity", ""), ("bearing.outer_conformity", "")];
        let scene = Scene::edited(THRUST, changes).unwrap();
        assert_eq!([scene.bearing.inner_conformity, scene.bearing.outer_conformity], [0.52, 0.53]);
        let note = &scene.notes()[0];
        assert!(
            note.contains("inner_conformity = 0.52") && note.contains("outer_conformity = 0.53"),
            "{note}"
        );
        let note = &notes(&changes[1..])[0];
        assert!(!note.contains("inner") && note.contains("outer_conformity = 0.53"), "{note}");
    }
}
