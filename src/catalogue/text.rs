//! The scene of a catalogue bearing, as text with comments: every estimate with its source and spread.

use std::fmt::{self, Display, Formatter};

use super::digits::{short, two_digits};
use super::estimate::USUAL;
use super::{Bearing, Cage, Candidate, CatalogueError, cage, rings};

/// [mm/min] speed of a scene times its pitch diameter: half of what grease-lubricated ball bearings are usually allowed.
const SPEED: f64 = 250_000.0;
/// [mm/min] the same of thrust bearings.
const SPEED_OF_THRUST: f64 = 60_000.0;
/// [-] load of a scene over C.
const LOAD: f64 = 0.1;

impl Display for Candidate {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [dynamic, static_] = self.errors.map(|error| 100.0 * error);
        let (balls, ball) = (self.geometry.balls, short(1e3 * self.geometry.ball_diameter, 5));
        let [_, outer] = self.geometry.conformities;
        // Candidates may differ in it alone.
        let close = if outer < USUAL[1] { format!(", outer groove {outer} D") } else { String::new() };
        write!(f, "{balls} x {ball} mm{close} ({dynamic:+.1} % in C, {static_:+.1} % in C0)")
    }
}

impl Bearing {
    /// Bore, outside diameter and width in words.
    pub fn dimensions(&self) -> String {
        let [bore, outside, width] = [self.bore, self.outside, self.width].map(|of| short(1e3 * of, 6));
        format!("{bore} x {outside} x {width} mm")
    }

    /// Description in a line.
    pub fn title(&self) -> String {
        let name = if self.designation.is_empty() { "Bearing" } else { &self.designation };
        let name = if self.hybrid { format!("{name} hybrid") } else { name.to_string() };
        let known = if self.inside.is_some() { "of its maker" } else { "estimated" };
        if self.is_deep_groove() {
            let class = match self.own_clearance {
                Some(_) => String::new(),
                None => format!(" {}", self.clearance.name()),
            };
            format!("{name}{class}, deep groove, {}, internal geometry {known}", self.dimensions())
        } else if self.is_thrust() {
            format!("{name}, thrust, {}, internal geometry {known}", self.dimensions())
        } else {
            let angle = short(self.contact_angle.to_degrees(), 4);
            format!("{name}, angular contact {angle} deg, {}, internal geometry {known}", self.dimensions())
        }
    }

    /// The scene with one of its candidates, counted from 1, as the text of a file.
    ///
    /// # Errors
    /// If no balls come near its ratings, or there is no such candidate.
    pub fn scene(&self, candidate: usize) -> Result<String, CatalogueError> {
        let candidates = self.candidates()?;
        let Some(chosen) = candidate.checked_sub(1).and_then(|index| candidates.get(index)) else {
            return Err(CatalogueError::Range {
                key: "candidate",
                value: candidate.to_string(),
                range: format!("[1, {}]", candidates.len()),
            });
        };
        Ok(self.text(&candidates, chosen))
    }

    /// \[kg] mass of the outer ring of its best candidate, estimated from its section.
    ///
    /// # Errors
    /// If no balls come near its ratings.
    pub fn outer_ring_mass(&self) -> Result<f64, CatalogueError> {
        let candidates = self.candidates()?;
        let chosen = candidates.first().ok_or_else(|| CatalogueError::Range {
            key: "candidate",
            value: "1".into(),
            range: "[1, 0]".into(),
        })?;
        Ok(self.rings(chosen)[1].mass)
    }

    fn text(&self, candidates: &[Candidate], chosen: &Candidate) -> String {
        let geometry = &chosen.geometry;
        let [dynamic, static_] =
            [self.dynamic_load_rating, self.static_load_rating].map(|of| short(1e-3 * of, 5));
        let others: Vec<String> =
            candidates.iter().filter(|other| *other != chosen).take(2).map(ToString::to_string).collect();
        let [inner, outer] = self.rings(chosen);
        let speed = if self.is_thrust() { SPEED_OF_THRUST } else { SPEED };
        let mut lines = vec![
            format!("# Given: boundary dimensions of ISO 15 and load ratings ({}).", self.source),
            "# What is estimated is not the maker's: measure it, or ask for it, where results depend on it."
                .into(),
        ];
        if !self.ignored.is_empty() {
            lines.push(format!("# In its name, and not simulated: {}.", self.ignored.join(", ")));
        }
        lines.extend([
            format!("title = {:?}", self.title()),
            String::new(),
            "[bearing]".into(),
            match self.inside {
                Some(_) => format!("# Balls, pitch diameter, grooves: of {}; by ISO 281 and ISO 76 they have: {chosen}.", self.source),
                None => format!(
                    "# Balls: estimated from C by ISO 281 and C0 by ISO 76 (4200 MPa): {chosen}.\n# Spread, the next in this order: {}.",
                    others.join("; ")
                ),
            },
            format!("balls = {}", geometry.balls),
            format!("ball_diameter = \"{} mm\"", short(1e3 * geometry.ball_diameter, 8)),
            match self.inside {
                Some(_) => "# Pitch diameter: if it is not of the maker, midway between bore and outside diameter.",
                None => "# Pitch diameter: estimated as midway between bore and outside diameter; spread 2 %.",
            }
            .into(),
            format!("pitch_diameter = \"{} mm\"", short(1e3 * geometry.pitch_diameter, 8)),
        ]);
        if self.is_deep_groove() {
            // Bearings are checked for their bore.
            let [least, largest] = self.clearance.limits(self.bore).unwrap_or_default().map(|of| 1e6 * of);
            lines.extend([
                format!(
                    "# Radial clearance: the middle of class {} of ISO 5753-1, spread {least:.0} to {largest:.0} um; fits and heat take from \
                     it.",
                    self.clearance.name()
                ),
                format!("diametral_clearance = \"{} um\"", short(0.5 * (least + largest), 4)),
            ]);
            if let Some(clearance) = self.own_clearance {
                lines.truncate(lines.len() - 2);
                lines.push(format!("# Radial clearance: of {}; fits and heat take from it.", self.source));
                lines.push(format!("diametral_clearance = \"{} um\"", short(1e6 * clearance, 6)));
            }
        } else {
            lines.extend([
                match self.is_thrust() {
                    true => "# Contact angle: that of washers that face each other.",
                    false => "# Contact angle: nominal; spread about 3 deg.",
                }
                .into(),
                format!("contact_angle = \"{} deg\"", short(self.contact_angle.to_degrees(), 6)),
            ]);
        }
        let [inner_conformity, outer_conformity] = geometry.conformities;
        let close = if self.is_thrust() {
            " of thrust bearings"
        } else if outer_conformity < USUAL[1] {
            "; the outer groove is close, as C0 is above that of 0.53"
        } else {
            ""
        };
        lines.extend([
            match self.inside {
                Some(_) => format!("# Conformities: if they are not of the maker, those that ISO 281 and ISO 76 are of{close}."),
                None => format!("# Conformities: estimated as those that ISO 281 and ISO 76 are of{close}; spread 0.505 to 0.54."),
            },
            format!("inner_conformity = {inner_conformity}"),
            format!("outer_conformity = {outer_conformity}"),
        ]);
        if self.hybrid {
            lines.extend([
                "".into(),
                "# Balls of silicon nitride.".into(),
                "[ball]".into(),
                "youngs_modulus = \"310 GPa\"".into(),
                "poisson_ratio = 0.26".into(),
                "density = \"3200 kg/m^3\"".into(),
                "thermal_expansion = \"3.2e-6 1/K\"".into(),
            ]);
        }
        lines.extend([
            String::new(),
            "# Load ratings of the catalogue.".into(),
            "[rating]".into(),
            format!("dynamic_load_rating = \"{dynamic} kN\""),
            format!("static_load_rating = \"{static_} kN\""),
            String::new(),
            "[effects]".into(),
            match self.cage {
                Cage::Ideal => "cage = \"ideal\"                # chosen: balls at even spacing; with \"none\" they touch where they meet",
                Cage::Estimated => "cage = true                   # chosen",
                Cage::None => "cage = \"none\"                 # chosen: balls touch where they meet",
            }
            .into(),
            "damping = \"0.02 s/m\"           # estimated: bouncing of balls ends within about 1 ms; spread a factor of 3".into(),
            String::new(),
        ]);
        if self.cage == Cage::Estimated {
            lines.extend(cage::section(geometry));
        }
        lines.extend([
            "[inner]".into(),
            "drive = \"wrench\"".into(),
            format!(
                "# The ring alone, without a shaft: estimated from its section with shoulders of {} D, spread 10 % (outer ring: {} kg).",
                rings::SHOULDER,
                short(outer.mass, 3)
            ),
            format!("mass = \"{} kg\"", short(inner.mass, 3)),
            {
                let [polar, transverse] = inner.inertia.map(|of| format!("\"{of:.2e} kg m^2\""));
                format!("inertia = [{polar}, {transverse}, {transverse}]")
            },
            String::new(),
            format!(
                "# An example, to be changed: {LOAD} C, and the speed at which it times the pitch diameter is {speed} mm/min."
            ),
            "[load]".into(),
            "duration = \"20 ms\"".into(),
            "output_interval = \"100 us\"".into(),
            format!("inner_speed = \"{} rpm\"", two_digits(speed / (1e3 * geometry.pitch_diameter))),
        ]);
        let force = two_digits(LOAD * self.dynamic_load_rating);
        if self.is_deep_groove() {
            lines.push(format!("y = {{ force = \"{force} N\" }}"));
            lines.push("x = { displacement = 0.0 }".into());
            lines.extend(["ry", "rz"].map(|tilt| format!("{tilt} = {{ rotation = 0.0 }}")));
        } else {
            lines.push(format!("x = {{ force = \"{force} N\" }}"));
        }
        if self.is_thrust() {
            lines.push("# Washers hold nothing across the axis.".into());
            lines.extend(["y", "z"].map(|across| format!("{across} = {{ displacement = 0.0 }}")));
            lines.extend(["ry", "rz"].map(|tilt| format!("{tilt} = {{ rotation = 0.0 }}")));
        }
        lines.push(String::new());
        lines.join("\n")
    }
}
