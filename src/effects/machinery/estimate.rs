//! Input of estimates of effects, a bearing under its load, and their verdicts: what the effect changes there.

use serde::Serialize;

use super::twin::Twin;

/// [-] share above which an effect matters, where the scene gives none (`effects.auto_threshold`).
pub const THRESHOLD: f64 = 0.05;

/// A ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingEstimate {
    /// \[m] radius of the bottom of its raceway.
    pub bottom: f64,
    /// [rad/s] largest speed of its script.
    pub speed: f64,
}

/// Spacing of balls where there is no cage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spacing {
    /// \[m] how far balls would lead or lag in a revolution, each at the speed at which it rolls by itself.
    pub lead: f64,
    /// \[m] gap between them.
    pub gap: f64,
    /// [m/s] largest difference of these speeds.
    pub difference: f64,
    /// \[W] power of the friction limit at their differences from the common speed.
    pub slipping: f64,
    /// \[N] load of two balls that strike each other at 1 m/s; it grows with the power 6/5 of the speed.
    pub blow: f64,
    /// [m/s] speed at which a ball that nothing holds would fall on the next one; 0 where all are held, or have no weight.
    pub falling: f64,
    /// Is there a ball that one race or none holds?
    pub unheld: bool,
    /// Is there such a ball, or weight?
    pub loose: bool,
    /// Does the bearing start from rest?
    pub from_rest: bool,
}

/// Outer dimensions of a bearing, none of which its contacts know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// \[m] bore of the inner ring.
    pub bore: f64,
    /// \[m] outside diameter of the outer ring.
    pub outside: f64,
    /// \[m] width.
    pub width: f64,
}

/// [W/(m2 K)] of the seats of rings: 0.016 W/mm2 at 50 K (ISO 15312).
const SEAT: f64 = 0.016e6 / 50.0;

impl Outline {
    /// [W/K] of the seats of the inner ring on its shaft and of the outer ring in its housing (ISO 15312).
    pub fn seats(&self) -> [f64; 2] {
        [self.bore, self.outside].map(|diameter| SEAT * std::f64::consts::PI * diameter * self.width)
    }

    /// Those of catalogues for a pitch and a ball diameter \[m]: bores and outside diameters of 6206, 209, 218 are 1.56 to 1.68 ball
    /// diameters from the pitch diameter, widths 1.35 to 1.68 of them.
    pub fn usual(pitch: f64, ball: f64) -> Self {
        Self { bore: (pitch - 1.65 * ball).max(0.1 * pitch), outside: pitch + 1.65 * ball, width: 1.6 * ball }
    }
}

/// A bearing in the equilibrium under its load, every race at the largest speed of its script.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// [-] share above which an effect matters.
    pub threshold: f64,
    /// \[m] largest sum of a ball's approaches at both races.
    pub deepest: f64,
    /// \[N] largest loads of a ball on the inner and the outer race.
    pub loads: [f64; 2],
    /// \[N] centrifugal force of the ball with the largest load on the inner race.
    pub centrifugal_force: f64,
    /// [N m] its gyroscopic moment.
    pub gyroscopic_moment: f64,
    /// \[m] ball radius.
    pub ball_radius: f64,
    /// [-] number of balls.
    pub balls: usize,
    /// \[m] pitch radius.
    pub pitch_radius: f64,
    /// [m/s] speed of the ball centres along their orbit.
    pub orbital_velocity: f64,
    /// [-] friction coefficient.
    pub friction: f64,
    /// Does the creep law saturate, so that grooves can slip?
    pub saturates: bool,
    /// Is the cage simulated?
    pub caged: bool,
    /// How balls keep their distance.
    pub spacing: Spacing,
    /// \[rad] least distance of a contact ellipse from a shoulder; negative where it is cut.
    pub shoulder_margin: f64,
    /// [-] largest share of a load beyond a shoulder.
    pub shoulder_share: f64,
    /// [Pa s] viscosity of the oil that the rating is for, where that is given.
    pub viscosity: Option<f64>,
    /// \[Pa] Young's modulus of the races.
    pub youngs_modulus: f64,
    /// Inner and outer ring.
    pub rings: [RingEstimate; 2],
    /// Are both races held by flanges, whose pose is given?
    pub flanged: [bool; 2],
    /// Outer dimensions; usual ones where the scene has none.
    pub outline: Outline,
    /// Is there oil, which may take heat as it flows?
    pub oiled: bool,
    /// [W/K] conductance of rings and balls to the oil, where the scene has it; else 0.
    pub oil_conductance: f64,
    /// \[W] all losses at a settled state.
    pub power: f64,
}

impl Estimate {
    /// [-] gyroscopic moment of the ball with the largest load over what friction on the inner race can hold; 0 without friction.
    pub fn gyroscopic(&self) -> f64 {
        let [largest, _] = self.loads;
        let held = self.friction * self.ball_radius * largest;
        if held > 0.0 { self.gyroscopic_moment.abs() / held } else { 0.0 }
    }

    /// [-] power of a cage that holds balls back to the common speed, over all losses; 0 of one with pockets \[m] in which they do as they like.
    pub fn held_back(&self, clearance: f64) -> f64 {
        if self.spacing.lead > clearance { self.spacing.slipping / self.power } else { 0.0 }
    }

    /// \[K] warming of the bearing by its losses, which go out through the seats of both rings, and to oil whose conductance is known.
    pub fn heating(&self) -> f64 {
        self.power / (self.outline.seats().iter().sum::<f64>() + self.oil_conductance)
    }
}

/// Changes by an effect of what a user asks for: each quantity with it over that without it, less 1; none of what is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Changes {
    /// [-] friction torque.
    pub torque: Option<f64>,
    /// [-] largest load of a ball on the inner race.
    pub largest_load: Option<f64>,
    /// [-] reference life.
    pub life: Option<f64>,
    /// [-] displacement of the loaded race: size of the difference of both.
    pub displacement: Option<f64>,
}

impl Changes {
    /// All that are known, by the names of their quantities.
    pub fn known(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let Self { torque, largest_load, life, displacement } = *self;
        let all = [
            ("torque", torque),
            ("largest load", largest_load),
            ("life", life),
            ("displacement", displacement),
        ];
        all.into_iter().filter_map(|(name, change)| Some((name, change?)))
    }

    /// The largest one; none where none is known.
    pub fn largest(&self) -> Option<(&'static str, f64)> {
        self.known().reduce(|most, other| if other.1.abs() > most.1.abs() { other } else { most })
    }

    /// Larger change of both, of each quantity.
    #[must_use]
    pub fn or_larger(self, other: Self) -> Self {
        let larger = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(if b.abs() > a.abs() { b } else { a }),
            (a, b) => a.or(b),
        };
        Self {
            torque: larger(self.torque, other.torque),
            largest_load: larger(self.largest_load, other.largest_load),
            life: larger(self.life, other.life),
            displacement: larger(self.displacement, other.displacement),
        }
    }

    /// In words: "torque +29.0 %, life -6.52 %".
    pub fn words(&self) -> String {
        let words = |(name, change): (&str, f64)| format!("{name} {}", signed_percent(change));
        self.known().map(words).collect::<Vec<_>>().join(", ")
    }
}

/// How an effect stands in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// Simulated.
    On,
    /// Not simulated.
    Off,
    /// Simulated in every scene.
    Always,
    /// There is no such effect yet.
    Missing,
}

/// Verdict of an estimate on an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Key of the effect; none of what cannot be switched.
    pub key: Option<&'static str>,
    /// Subject in a few words.
    pub subject: &'static str,
    /// Is it simulated?
    pub standing: Standing,
    /// Quantity of the value: the quantity that changes most.
    pub quantity: &'static str,
    /// Value in `unit`: the size of the largest change, where changes are known.
    pub value: f64,
    /// All changes by the effect, where they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub changes: Option<Changes>,
    /// Where the value is from.
    pub from: &'static str,
    /// Unit of value and threshold; empty for a share.
    pub unit: &'static str,
    /// Value beyond which it matters.
    pub threshold: f64,
    /// Does it matter?
    pub matters: bool,
    /// Value and what it is a share of, in a sentence with units.
    pub sentence: String,
    /// Text to write in the scene to switch it on, or what that needs.
    pub write: &'static str,
    /// Key that switches it on, where the scene has all it needs: what `effects = "auto"` sets.
    #[serde(skip)]
    pub auto: Option<&'static str>,
}

/// Where the value of a verdict is from.
pub const CLOSED_FORM: &str = "closed form";
/// See [`CLOSED_FORM`].
pub const TWO_STATES: &str = "two settled states";

impl Verdict {
    /// A share of something by a closed form, which matters above a threshold, and what to write about it.
    pub fn new(
        (subject, quantity): (&'static str, &'static str),
        standing: Standing,
        (value, threshold): (f64, f64),
        sentence: String,
        write: &'static str,
    ) -> Self {
        Self {
            key: None,
            subject,
            standing,
            quantity,
            value,
            changes: None,
            from: CLOSED_FORM,
            unit: "",
            threshold,
            matters: value > threshold,
            sentence,
            write,
            auto: None,
        }
    }

    /// Verdict of an effect that both twins are there of: it matters where it changes a quantity by more than the threshold.
    pub fn of_twin(twin: &Twin, changes: Changes, threshold: f64, tail: &str) -> Self {
        let (quantity, change) = changes.largest().unwrap_or(("torque", 0.0));
        let standing = if twin.on { Standing::On } else { Standing::Off };
        let changed = match (twin.on, changes.words()) {
            (_, words) if words.is_empty() => "changes nothing that is known".into(),
            (true, words) => words,
            (false, words) => format!("would change {words}"),
        };
        let setting = if twin.setting.is_empty() { "" } else { ": " };
        let sentence = format!("{}{setting}{changed}{tail}{}", twin.setting, twin.remark);
        let threshold = if twin.always_matters { 0.0 } else { threshold };
        Self {
            key: Some(twin.key),
            changes: Some(changes),
            from: TWO_STATES,
            matters: change.abs() > threshold || twin.always_matters,
            auto: twin.auto,
            ..Self::new((twin.subject, quantity), standing, (change.abs(), threshold), sentence, twin.write)
        }
    }

    /// Verdict of an effect whose other twin has no settled state: it decides whether the bearing can run at all.
    pub fn of_no_state(twin: &Twin, threshold: f64, why: &str) -> Self {
        let with = if twin.on { "without" } else { "with" };
        Self {
            matters: true,
            changes: None,
            sentence: format!("no settled state {with} it: {why}"),
            ..Self::of_twin(twin, Changes::default(), threshold, "")
        }
    }

    /// Is it off, and would matter?
    pub fn is_missed(&self) -> bool {
        self.matters && matches!(self.standing, Standing::Off | Standing::Missing)
    }

    /// Is it on, and does not matter?
    pub fn is_idle(&self) -> bool {
        !self.matters && self.standing == Standing::On
    }
}

/// A share in percent, in three digits: 0.0123 is "1.23 %".
pub fn percent(share: f64) -> String {
    digits(100.0 * share) + " %"
}

/// Percentage of a change, with its sign: "+1.23 %".
pub fn signed_percent(change: f64) -> String {
    // Below a thousandth of a percent is what searches leave.
    let change = if change.abs() < 1e-5 { 0.0 } else { change };
    format!("{}{}", if change > 0.0 { "+" } else { "" }, percent(change))
}

/// A number in three digits, never as a power of ten but where it is very small or large.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if size == 0.0 => "0".into(),
        _ if !(1e-3..1e5).contains(&size) => format!("{value:.1e}"),
        _ => {
            let decimals = (2.0 - size.log10().floor()).clamp(0.0, 5.0) as usize;
            format!("{value:.decimals$}")
        }
    }
}

/// Effects that are off and would matter, a line each; nothing of what does not.
pub fn missed(verdicts: &[Verdict]) -> Vec<String> {
    let line = |verdict: &Verdict| {
        let Verdict { subject, sentence, write, .. } = verdict;
        match verdict.standing {
            Standing::Missing => format!("not simulated, would matter: {subject}: {sentence}"),
            _ => format!("off, would matter: {subject}: {sentence} ({write})"),
        }
    };
    verdicts.iter().filter(|verdict| verdict.is_missed()).map(line).collect()
}
