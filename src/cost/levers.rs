//! What a user can turn: every lever with its settings, as changed copies of a scene.

use strum::{IntoStaticStr, VariantArray};

use crate::scene::{Accuracy, CreepLaw, Drive, Scene};
use crate::units::Time;

/// A lever of accuracy and speed; one curve in the plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, IntoStaticStr, VariantArray)]
pub enum Lever {
    /// Quasi-static or dynamic.
    #[strum(serialize = "level")]
    Level,
    /// Creep law.
    #[strum(serialize = "creep law")]
    CreepLaw,
    /// Goal of `solver.accuracy`.
    #[strum(serialize = "goal")]
    Goal,
    /// Fixed step.
    #[strum(serialize = "fixed step")]
    FixedStep,
    /// Tolerance of the local error, the step being free.
    #[strum(serialize = "tolerance")]
    Tolerance,
    /// Largest step at the scene's tolerance.
    #[strum(serialize = "step cap")]
    StepCap,
    /// HHT damping.
    #[strum(serialize = "alpha_f")]
    AlphaF,
    /// Contraction above which the matrix is renewed.
    #[strum(serialize = "matrix reuse")]
    MatrixReuse,
    /// Communication step, inputs as they are at its start.
    #[strum(serialize = "communication (held)")]
    CommunicationHeld,
    /// Communication step, inputs at its start with their derivatives.
    #[strum(serialize = "communication (derivatives)")]
    CommunicationDerivatives,
    /// Communication step, inputs that lead to where the importer is at its end.
    #[strum(serialize = "communication (ahead)")]
    CommunicationAhead,
}

impl Lever {
    /// Name in tables and plots.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// What the lever's error is measured against.
    pub fn reference(self) -> ReferenceKind {
        match self {
            Self::Level | Self::CreepLaw => ReferenceKind::Model,
            _ => ReferenceKind::Numerical,
        }
    }
}

/// What an error is measured against; the two are never mixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum ReferenceKind {
    /// The same model at a tiny step.
    Numerical,
    /// The richest model at the scene's own step.
    Model,
}

/// Quasi-static or dynamic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// An equilibrium at every communication point; no time integration.
    Equilibrium,
    /// Time integration.
    Dynamic,
}

/// What an importer knows when it sets the inputs of a communication step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// Pose, twist and loads at the start of the step.
    Held,
    /// The same, and the rate of the twist.
    Derivatives,
    /// Pose, twist and loads at the end of the step.
    Ahead,
}

/// One way to run a scene.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Lever it belongs to.
    pub lever: Lever,
    /// What the lever is set to, as shown.
    pub label: String,
    /// Scene as changed by the lever.
    pub scene: Scene,
    /// Quasi-static or dynamic.
    pub level: Level,
    /// [s] communication step.
    pub communication: f64,
    /// What the importer knows.
    pub inputs: Inputs,
}

impl Setting {
    /// A scene as it is, with inputs that add no error of their own.
    pub fn plain(lever: Lever, label: impl Into<String>, scene: Scene) -> Self {
        let communication = scene.load.output_interval.0;
        let (level, inputs) = (Level::Dynamic, Inputs::Ahead);
        Self { lever, label: label.into(), scene, level, communication, inputs }
    }

    /// The scene at a fixed step [s]: error control is opened so far that only Newton's method could ask for less.
    pub fn fixed_step(scene: &Scene, step: f64) -> Self {
        let mut scene = scene.clone();
        let solver = &mut scene.solver;
        (solver.initial_step, solver.max_step) = (Time(step), Time(step));
        solver.min_step = Time(solver.min_step.0.min(step));
        solver.tolerance = OPEN_TOLERANCE;
        Self::plain(Lever::FixedStep, seconds(step), scene)
    }

    /// The scene with another creep law.
    pub fn creep_law(scene: &Scene, law: CreepLaw) -> Self {
        let mut scene = scene.clone();
        scene.effects.creep = law;
        Self::plain(Lever::CreepLaw, <&str>::from(law), scene)
    }
}

/// [-] largest tolerance that a scene may have.
const OPEN_TOLERANCE: f64 = 1e-2;
/// Halvings of the output interval: fixed steps of the ladder, and the two steps of the reference.
const FIXED_STEPS: std::ops::RangeInclusive<i32> = 0..=8;
const REFERENCE_HALVINGS: [i32; 2] = [10, 11];
const TOLERANCES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
const STEP_CAPS: [f64; 6] = [2e-4, 1e-4, 5e-5, 2e-5, 5e-6, 2e-6];
const DAMPINGS: [f64; 6] = [0.005, 0.02, 0.05, 0.1, 0.2, 1.0 / 3.0];
const REUSES: [f64; 5] = [0.0, 0.1, 0.3, 0.6, 1.0];
/// Communication steps over the output interval.
const COMMUNICATION: [f64; 7] = [0.125, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0];

/// [s] the tiny step of the numerical reference, then twice that, which gives its error bar.
pub fn reference_steps(scene: &Scene) -> [f64; 2] {
    let [coarse, fine] = REFERENCE_HALVINGS.map(|k| scene.load.output_interval.0 * f64::from(-k).exp2());
    [fine, coarse]
}

/// The richest creep law there is.
pub fn richest_law() -> CreepLaw {
    CreepLaw::VARIANTS.last().copied().unwrap_or_default()
}

/// Creep laws of the study: all but the polynomials, which take a millisecond a contact and are less accurate than the
/// table; `docs/rolling-contact.md` has their cost.
pub fn studied_laws() -> impl Iterator<Item = CreepLaw> {
    CreepLaw::VARIANTS.iter().copied().filter(|law| *law != CreepLaw::Kalker)
}

/// All settings of the levers that change the model, at the scene's own step.
pub fn model_settings(scene: &Scene) -> Vec<Setting> {
    let quasi_static =
        Setting { level: Level::Equilibrium, ..Setting::plain(Lever::Level, "equilibrium", scene.clone()) };
    let mut richest = Setting::creep_law(scene, richest_law());
    (richest.lever, richest.label) = (Lever::Level, "dynamic".to_string());
    let laws = studied_laws().map(|law| Setting::creep_law(scene, law));
    [quasi_static, richest].into_iter().chain(laws).collect()
}

/// All settings of the levers that leave the model as it is.
pub fn numerical_settings(scene: &Scene) -> Vec<Setting> {
    let interval = scene.load.output_interval.0;
    let changed = |lever, label: String, change: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        Setting::plain(lever, label, scene)
    };
    let goals = Accuracy::VARIANTS
        .iter()
        .map(|&goal| changed(Lever::Goal, <&str>::from(goal).to_string(), &|s| s.solver = goal.solver()));
    let fixed = FIXED_STEPS.map(|k| Setting::fixed_step(scene, interval * f64::from(-k).exp2()));
    let tolerances = TOLERANCES.iter().map(|&tolerance| {
        changed(Lever::Tolerance, format!("{tolerance:e}"), &|s| {
            s.solver.tolerance = tolerance;
            s.solver.max_step = Time(interval);
        })
    });
    let caps = STEP_CAPS.iter().map(|&cap| {
        changed(Lever::StepCap, seconds(cap), &|s| {
            let solver = &mut s.solver;
            solver.max_step = Time(cap);
            solver.initial_step = Time(solver.initial_step.0.min(cap));
        })
    });
    let dampings = DAMPINGS
        .iter()
        .map(|&alpha_f| changed(Lever::AlphaF, format!("{alpha_f:.3}"), &|s| s.solver.alpha_f = alpha_f));
    let reuses = REUSES
        .iter()
        .map(|&reuse| changed(Lever::MatrixReuse, reuse.to_string(), &|s| s.solver.matrix_reuse = reuse));
    let importers = [
        (Lever::CommunicationHeld, Inputs::Held),
        (Lever::CommunicationDerivatives, Inputs::Derivatives),
        (Lever::CommunicationAhead, Inputs::Ahead),
    ];
    let communication = importers
        .into_iter()
        // Derivatives are those of a twist: a race under a wrench has none to give.
        .filter(|&(_, inputs)| inputs != Inputs::Derivatives || scene.inner.drive == Drive::Pose)
        .flat_map(|(lever, inputs)| {
            COMMUNICATION.map(|factor| {
                let communication = factor * interval;
                let label = seconds(communication);
                Setting { communication, inputs, ..Setting::plain(lever, label, scene.clone()) }
            })
        })
        .filter(|setting| setting.communication <= 0.5 * scene.load.duration.0);
    goals
        .chain(fixed)
        .chain(tolerances)
        .chain(caps)
        .chain(dampings)
        .chain(reuses)
        .chain(communication)
        .collect()
}

/// A time as shown: microseconds, four digits.
pub fn seconds(time: f64) -> String {
    let microseconds = time * 1e6;
    let digits = (3.0 - microseconds.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{microseconds:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} us")
}
