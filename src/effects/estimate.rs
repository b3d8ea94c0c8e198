//! What an estimate of an effect may know of a bearing under its load, and what it says: whether the effect matters there.

use nalgebra::{Matrix2, Vector2};
use serde::Serialize;

/// [-] share above which an effect matters, where the scene gives none (`effects.auto_threshold`).
pub const THRESHOLD: f64 = 0.05;

/// A ball-race contact under load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEstimate {
    /// Ball, counted from 0.
    pub ball: usize,
    /// The inner (0) or outer (1) race.
    pub race: usize,
    /// \[N] normal load.
    pub load: f64,
    /// \[m] semi-axes along rolling and transverse to it.
    pub semi_axes: [f64; 2],
    /// [1/m] curvatures of ball and race together, along rolling and transverse to it.
    pub curvatures: [f64; 2],
    /// [1/m] mean transverse curvature of ball and groove over 2.
    pub bend: f64,
    /// [rad/s] angular velocity of ball and race against each other along the contact plane: that of rolling.
    pub rolling: f64,
    /// [rad/s] angular velocity of ball and race against each other about the normal, all of it on the inner race.
    pub spin: f64,
    /// [m/s] speed at which the bottom of the groove passes the contact.
    pub rolling_speed: f64,
}

/// A ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingEstimate {
    /// [m s2] radial displacement of the bottom of its raceway by rotation, over the square of the speed.
    pub spun: f64,
    /// \[m] radius of the bottom of its raceway.
    pub bottom: f64,
    /// [1/K] coefficient of thermal expansion.
    pub expansion: f64,
    /// [rad/s] largest speed of its script.
    pub speed: f64,
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

/// The ball with the largest approaches, by its contacts with the inner and the outer race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallEstimate {
    /// \[N] loads.
    pub loads: [f64; 2],
    /// \[m] approaches.
    pub approaches: [f64; 2],
    /// \[rad] contact angles.
    pub angles: [f64; 2],
    /// \[m] distances of the ball's centre from the grooves' centres.
    pub distances: [f64; 2],
}

impl BallEstimate {
    /// \[m] changes of its approaches while its races are held and their grooves move away from the axis, to first order: the ball
    /// goes to where all forces on it are in balance again, its centrifugal force as before.
    fn approaches_by(&self, outwards: [f64; 2]) -> [f64; 2] {
        // Towards the contact, axial and radial: inner forces point out of the axis, outer ones into it.
        let towards = |race: usize| {
            let (sine, cosine) = self.angles[race].sin_cos();
            Vector2::new(sine, cosine) * if race == 0 { 1.0 } else { -1.0 }
        };
        // A force towards a groove's centre turns with the line to it.
        let stiffness = |race: usize| {
            let (n, load) = (towards(race), self.loads[race]);
            let along = 1.5 * load / self.approaches[race].max(f64::MIN_POSITIVE);
            let turning = load / self.distances[race];
            n * n.transpose() * (along - turning) + Matrix2::identity() * turning
        };
        let [inner, outer] = [0, 1].map(stiffness);
        let moved = outwards.map(|outwards| Vector2::new(0.0, outwards));
        let push = inner * moved[0] + outer * moved[1];
        let ball = (inner + outer).lu().solve(&push).unwrap_or_else(Vector2::zeros);
        [0, 1].map(|race| towards(race).dot(&(moved[race] - ball)))
    }
}

/// A bearing in the equilibrium under its load, every race at the largest speed of its script.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// [-] share above which an effect matters.
    pub threshold: f64,
    /// All contacts that carry load.
    pub contacts: Vec<ContactEstimate>,
    /// \[m] largest sum of a ball's approaches at both races.
    pub deepest: f64,
    /// The ball that has it.
    pub deepest_ball: BallEstimate,
    /// \[N] largest and least load of a ball on the inner race, among those that have one.
    pub loads: [f64; 2],
    /// \[rad] contact angle of the ball with the largest load at the inner race.
    pub contact_angle: f64,
    /// \[N] its centrifugal force.
    pub centrifugal_force: f64,
    /// [N m] its gyroscopic moment.
    pub gyroscopic_moment: f64,
    /// \[m] ball radius.
    pub ball_radius: f64,
    /// [m/s] speed of the ball centres along their orbit.
    pub orbital_velocity: f64,
    /// [-] friction coefficient.
    pub friction: f64,
    /// Does the creep law saturate, so that grooves can slip?
    pub saturates: bool,
    /// Is the cage simulated?
    pub caged: bool,
    /// \[N] load that the bearing carries.
    pub load: f64,
    /// \[kg] mass of balls, cage and races under a wrench.
    pub mass: f64,
    /// [N/m] largest stiffness of the inner race against the outer one along x, y, z.
    pub stiffness: f64,
    /// \[rad] least distance of a contact ellipse from a shoulder; negative where it is cut.
    pub shoulder_margin: f64,
    /// [-] largest share of a load beyond a shoulder.
    pub shoulder_share: f64,
    /// \[Pa] reduced modulus E' of elastohydrodynamics, 2 over the compliance of both materials.
    pub modulus: f64,
    /// [Pa s] viscosity of the oil that the rating is for, where that is given.
    pub viscosity: Option<f64>,
    /// \[Pa] Young's modulus of the races.
    pub youngs_modulus: f64,
    /// Inner and outer ring.
    pub rings: [RingEstimate; 2],
    /// Outer dimensions; usual ones where the scene has none.
    pub outline: Outline,
    /// \[m] largest change of the diametral clearance by growth as the scene has it; none where that is not known beforehand.
    pub clearance_change: Option<f64>,
    /// Is there oil, which may take heat as it flows?
    pub oiled: bool,
    /// [W/K] conductance of rings and balls to the oil, where the scene has it; else 0.
    pub oil_conductance: f64,
}

impl Estimate {
    /// [-] gyroscopic moment of the ball with the largest load over what friction on the inner race can hold; 0 without friction.
    pub fn gyroscopic(&self) -> f64 {
        let [largest, _] = self.loads;
        let held = self.friction * self.ball_radius * largest;
        if held > 0.0 { self.gyroscopic_moment.abs() / held } else { 0.0 }
    }

    /// [-] change of the deepest approach over itself while races are held and their grooves move away from the axis \[m], inner first;
    /// and its closed form, with a ball that stays at its contact angle and is as stiff as the races are far apart.
    pub fn deepens(&self, outwards: [f64; 2]) -> [f64; 2] {
        let change: f64 = self.deepest_ball.approaches_by(outwards).into_iter().sum();
        let [inner, outer] = outwards;
        [change.abs() / self.deepest, (inner - outer).abs() * self.contact_angle.cos() / self.deepest]
    }

    /// [-] change of the deepest ball's load on the inner race over itself, by a height \[m] of that race; and its closed form. Loads go
    /// with the power 3/2 of approaches.
    pub fn reloads(&self, height: f64) -> [f64; 2] {
        let [inner, _] = self.deepest_ball.approaches_by([height, 0.0]);
        [1.5 * inner.abs() / self.deepest_ball.approaches[0], 1.5 * height / self.deepest]
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

/// What an estimate says of an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Key of the effect; none of what cannot be switched.
    pub key: Option<&'static str>,
    /// What it is of, in a few words.
    pub subject: &'static str,
    /// Is it simulated?
    pub standing: Standing,
    /// Value in `unit`.
    pub value: f64,
    /// Its closed form, where the value looks closer: as if balls stayed at their contact angles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_form: Option<f64>,
    /// Unit of value and threshold; empty for a share.
    pub unit: &'static str,
    /// Value beyond which it matters.
    pub threshold: f64,
    /// Does it matter?
    pub matters: bool,
    /// Value and what it is a share of, in a sentence with units.
    pub sentence: String,
    /// What to write in the scene to switch it on, or what that needs.
    pub write: &'static str,
    /// Key that switches it on, where the scene has all it needs: what `effects = "auto"` sets.
    #[serde(skip)]
    pub auto: Option<&'static str>,
}

impl Verdict {
    /// Of a share that matters beyond a threshold.
    pub fn share(
        key: &'static str,
        subject: &'static str,
        on: bool,
        (value, threshold): (f64, f64),
        sentence: String,
    ) -> Self {
        let standing = if on { Standing::On } else { Standing::Off };
        Self { key: Some(key), ..Self::new(subject, standing, (value, threshold), sentence, "") }
    }

    /// A share of no effect's own, which matters above a threshold, and what to write about it.
    pub fn new(
        subject: &'static str,
        standing: Standing,
        (value, threshold): (f64, f64),
        sentence: String,
        write: &'static str,
    ) -> Self {
        Self {
            key: None,
            subject,
            standing,
            value,
            closed_form: None,
            unit: "",
            threshold,
            matters: value > threshold,
            sentence,
            write,
            auto: None,
        }
    }

    /// With the closed form of the value.
    #[must_use]
    pub fn closer_than(self, closed_form: f64) -> Self {
        Self { closed_form: Some(closed_form), ..self }
    }

    /// With what to write in the scene.
    #[must_use]
    pub fn written(self, write: &'static str) -> Self {
        Self { write, ..self }
    }

    /// With the key that switches it on, if that is all it needs.
    #[must_use]
    pub fn automatic(self, key: Option<&'static str>) -> Self {
        Self { auto: key, ..self }
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

/// What is off and would matter, a line each; nothing of what does not.
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
