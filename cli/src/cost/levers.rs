//! Levers (see [`crate::cost`]) and their settings, as changed copies of a scene.

use clap::ValueEnum;
use strum::{IntoStaticStr, VariantArray};

use roulement::scene::machine::MachineScene;
use roulement::scene::system::MountedScene;
use roulement::scene::units::Time;
use roulement::scene::{self, Accuracy, CreepLaw, Drive, Scales, Scene, Solver};
use roulement::schema::Method;

/// A setting that trades accuracy for speed; one curve in the plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, IntoStaticStr, ValueEnum, VariantArray)]
pub enum Lever {
    /// Quasi-static or dynamic.
    #[strum(serialize = "level")]
    Level,
    /// Creep law, degree of its polynomials, slip of bent grooves.
    #[strum(serialize = "creep law")]
    CreepLaw,
    /// Steps where nothing is said, and those of the scene if it says some.
    #[strum(serialize = "default")]
    Default,
    /// Goal of `solver.accuracy`.
    #[strum(serialize = "goal")]
    Goal,
    /// Fixed step.
    #[strum(serialize = "fixed step")]
    FixedStep,
    /// Tolerance of the local error, the step being free.
    #[strum(serialize = "tolerance")]
    Tolerance,
    /// Tolerance of the local error with the other method of time integration, the step being free.
    #[strum(serialize = "method")]
    Method,
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

    /// Is it a communication step?
    pub fn is_communication(self) -> bool {
        matches!(self, Self::CommunicationHeld | Self::CommunicationDerivatives | Self::CommunicationAhead)
    }

    /// Reference of the lever's error.
    pub fn reference(self) -> ReferenceKind {
        match self {
            Self::Level | Self::CreepLaw => ReferenceKind::Model,
            _ => ReferenceKind::Numerical,
        }
    }
}

/// Kind of reference of an error; the two are never mixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum ReferenceKind {
    /// Numerical error: against the scene's own model at a tiny step.
    Numerical,
    /// Model error: against the richest model at the scene's own step.
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

/// Knowledge of the importer when it sets the inputs of a communication step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// Pose, twist and loads at the start of the step.
    Held,
    /// Pose, twist, rate of the twist and loads at the start of the step.
    Derivatives,
    /// Pose, twist and loads at the end of the step.
    Ahead,
}

/// One way to run a scene.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Lever it belongs to.
    pub lever: Lever,
    /// Value of the lever, as shown.
    pub label: String,
    /// Scene as changed by the lever.
    pub scene: MachineScene,
    /// Quasi-static or dynamic.
    pub level: Level,
    /// \[s] communication step.
    pub communication: f64,
    /// Knowledge of the importer.
    pub inputs: Inputs,
}

impl Setting {
    /// A scene as it is, with inputs that add no error of their own.
    pub fn plain(lever: Lever, label: impl Into<String>, scene: MachineScene) -> Self {
        let communication = scene.output_interval();
        let (level, inputs) = (Level::Dynamic, Inputs::Ahead);
        Self { lever, label: label.into(), scene, level, communication, inputs }
    }

    /// The scene at a fixed step \[s]: error control is opened so far that only Newton's method could ask for less.
    pub fn fixed_step(scene: &MachineScene, step: f64) -> Self {
        let scene = scene.with_solver(|solver| {
            (solver.initial_step, solver.max_step) = (Time(step), Time(step));
            solver.min_step = Time(solver.min_step.0.min(step));
            solver.tolerance = OPEN_TOLERANCE;
        });
        Self::plain(Lever::FixedStep, seconds(step), scene)
    }

    /// The scene with another creep model.
    pub fn creep(scene: &MachineScene, model: CreepModel) -> Self {
        let scene = scene.with(|scene| {
            let effects = &mut scene.effects;
            effects.creep.law = model.law;
            effects.creep.kalker_degree = model.degree.unwrap_or(effects.creep.kalker_degree);
            effects.groove_slip.on = model.heathcote_slip;
        });
        Self::plain(Lever::CreepLaw, model.name(), scene)
    }
}

/// A creep law with what it can be combined with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CreepModel {
    /// Law.
    pub law: CreepLaw,
    /// [-] degree M of the polynomials, of the law that has them.
    pub degree: Option<usize>,
    /// With the slip of bent grooves.
    pub heathcote_slip: bool,
}

impl CreepModel {
    /// The most exact there is. Against boundary elements the table is closer than polynomials of degree 7 and than every
    /// closed form, and with the slip of bent grooves no other law is closer in spin moment and power
    /// (`docs/rolling-contact.md`).
    pub const RICHEST: Self = Self { law: CreepLaw::KalkerTable, degree: None, heathcote_slip: true };

    /// Creep model of a scene; of several bearings, that of the first.
    pub fn of(scene: &MachineScene) -> Self {
        let scene = first(scene);
        let creep = &scene.effects.creep;
        let degree = (creep.law == CreepLaw::Kalker).then_some(creep.kalker_degree);
        Self { law: creep.law, degree, heathcote_slip: scene.effects.groove_slip.on }
    }

    /// Creep models of the study, from the poorest to the richest. `linear` is left out: it is unbounded, wrong by up to six
    /// decades where balls spin.
    pub fn studied() -> Vec<Self> {
        let laws = CreepLaw::VARIANTS.iter().filter(|law| **law != CreepLaw::Linear);
        let degrees = |law| if law == CreepLaw::Kalker { DEGREES.map(Some).to_vec() } else { vec![None] };
        let slips = |law| if law == CreepLaw::Frictionless { &[false][..] } else { &[false, true] };
        laws.flat_map(|&law| degrees(law).into_iter().map(move |degree| (law, degree)))
            .flat_map(|(law, degree)| {
                slips(law).iter().map(move |&heathcote_slip| Self { law, degree, heathcote_slip })
            })
            .collect()
    }

    /// Law, degree and slip as shown.
    pub fn name(self) -> String {
        let law: &str = self.law.into();
        let degree = self.degree.map(|degree| format!(" M={degree}")).unwrap_or_default();
        format!("{law}{degree}{}", if self.heathcote_slip { " + Heathcote slip" } else { "" })
    }
}

/// [-] degrees of the polynomials: odd ones, whose errors fall by steps (`docs/rolling-contact.md`).
const DEGREES: [usize; 4] = [1, 3, 5, 7];
/// Name of the richest model at the lever `level`.
pub const DYNAMIC: &str = "dynamic";
/// Steps of a scene that says something of them, at the lever `default`.
pub const STEPS_OF_SCENE: &str = "steps of the scene";
/// [-] largest tolerance that a scene may have.
const OPEN_TOLERANCE: f64 = 1e-2;
/// [-] tiny step of the reference in periods of the most loaded ball between its races, about.
const REFERENCE_STEP: f64 = 0.0036;
/// [-] halvings by which the smallest fixed step of the ladder is above that of the reference.
const ABOVE_REFERENCE: i32 = 3;
const TOLERANCES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
const STEP_CAPS: [f64; 6] = [2e-4, 1e-4, 5e-5, 2e-5, 5e-6, 2e-6];
const DAMPINGS: [f64; 6] = [0.005, 0.02, 0.05, 0.1, 0.2, 1.0 / 3.0];
const REUSES: [f64; 5] = [0.0, 0.1, 0.3, 0.6, 1.0];
/// Communication steps over the output interval.
const COMMUNICATION: [f64; 7] = [0.125, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0];

/// The first bearing.
fn first(scene: &MachineScene) -> &Scene {
    match scene {
        MachineScene::Bearing(scene) => scene,
        MachineScene::Shaft(scene) => &scene.bearings[0].scene,
    }
}

/// \[s] the tiny step of the numerical reference, then twice that, which gives its error bar.
pub fn reference_steps(scene: &MachineScene) -> [f64; 2] {
    let fine = scene.output_interval() * f64::from(-reference_halvings(scene)).exp2();
    [fine, 2.0 * fine]
}

/// [-] halvings of the output interval that lead to the tiny step; enough for a ladder of fixed steps.
fn reference_halvings(scene: &MachineScene) -> i32 {
    let frequencies = scene.bearings().into_iter().map(|(_, scene)| Scales::of(scene).frequency);
    let step = REFERENCE_STEP / frequencies.fold(f64::MIN_POSITIVE, f64::max);
    let halvings = (scene.output_interval() / step).log2().round() as i32;
    halvings.clamp(ABOVE_REFERENCE + 3, 16)
}

/// All settings of the levers that change the model, at the scene's own step.
pub fn model_settings(scene: &MachineScene) -> Vec<Setting> {
    let quasi_static =
        Setting { level: Level::Equilibrium, ..Setting::plain(Lever::Level, "equilibrium", scene.clone()) };
    let mut richest = Setting::creep(scene, CreepModel::RICHEST);
    (richest.lever, richest.label) = (Lever::Level, DYNAMIC.to_string());
    let laws = CreepModel::studied().into_iter().map(|model| Setting::creep(scene, model));
    [quasi_static, richest].into_iter().chain(laws).collect()
}

/// The scene with the steps that it has where nothing is said of accuracy, then with its own if it says something.
pub fn usual_settings(scene: &MachineScene) -> Vec<Setting> {
    let usual = scene.with(|scene| {
        let Solver { method, alpha_f, matrix_reuse, level, .. } = scene.solver;
        follow(scene, Solver { method, alpha_f, matrix_reuse, level, ..Solver::default() });
    });
    let solvers = |scene: &MachineScene| -> Vec<Solver> {
        scene.bearings().into_iter().map(|(_, scene)| scene.solver).collect()
    };
    let own = (solvers(scene) != solvers(&usual))
        .then(|| Setting::plain(Lever::Default, STEPS_OF_SCENE, scene.clone()));
    std::iter::once(Setting::plain(Lever::Default, "default steps", usual)).chain(own).collect()
}

/// Does the method of order 3 know all of a scene? It knows neither balls at even spacing nor bearings without states.
fn takes_order_three(scene: &MachineScene) -> bool {
    let resting = |bearing: &MountedScene| bearing.level() == scene::Level::Equilibrium;
    let kept_apart = |(_, scene): (_, &Scene)| scene.effects.cage.is_ideal();
    !scene.shaft().is_some_and(|shaft| shaft.bearings.iter().any(resting))
        && !scene.bearings().into_iter().any(kept_apart)
}

/// Gives a bearing other settings of the integration, as where its scene is read.
fn follow(scene: &mut Scene, solver: Solver) {
    let Scales { approach, frequency } = Scales::of(scene);
    scene.solver = solver;
    scene.solver.follow(frequency, approach);
    scene.solver.fit_to(scene.bearing.ball_diameter.0);
}

/// All settings of the levers that leave the model as it is.
pub fn numerical_settings(scene: &MachineScene) -> Vec<Setting> {
    let interval = scene.output_interval();
    let changed =
        |lever, label: String, change: &dyn Fn(&mut Scene)| Setting::plain(lever, label, scene.with(change));
    let goals = Accuracy::VARIANTS
        .iter()
        .map(|&goal| changed(Lever::Goal, <&str>::from(goal).to_string(), &|s| follow(s, goal.solver())));
    let fixed = (0..=reference_halvings(scene) - ABOVE_REFERENCE)
        .map(|k| Setting::fixed_step(scene, interval * f64::from(-k).exp2()));
    let toleranced = |lever, label: String, tolerance: f64, method: Method| {
        changed(lever, label, &|s| {
            s.solver.method = method;
            s.solver.tolerance = tolerance;
            // As where a scene gives one.
            s.solver.unresolved = 0.0;
            s.solver.max_step = Time(interval);
        })
    };
    let method = scene.solver().method;
    let tolerances = TOLERANCES
        .iter()
        .map(|&tolerance| toleranced(Lever::Tolerance, format!("{tolerance:e}"), tolerance, method));
    let takes = |other: Method| other == Method::Hht || takes_order_three(scene);
    let others = Method::VARIANTS.iter().filter(|&&other| other != method && takes(other));
    let methods = others.flat_map(|&other| {
        let name: &str = other.into();
        TOLERANCES
            .map(|tolerance| toleranced(Lever::Method, format!("{name} {tolerance:e}"), tolerance, other))
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
        // Derivatives are those of a twist: a race under a wrench has none to give, nor has a shaft under loads.
        .filter(|&(_, inputs)| {
            inputs != Inputs::Derivatives
                || scene.shaft().is_none() && first(scene).inner.drive == Drive::Pose
        })
        .flat_map(|(lever, inputs)| {
            COMMUNICATION.map(|factor| {
                let communication = factor * interval;
                let label = seconds(communication);
                Setting { communication, inputs, ..Setting::plain(lever, label, scene.clone()) }
            })
        })
        .filter(|setting| setting.communication <= 0.5 * scene.duration());
    usual_settings(scene)
        .into_iter()
        .chain(goals)
        .chain(fixed)
        .chain(tolerances)
        .chain(methods)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_default_steps_are_those_of_a_scene_that_says_nothing_of_them() {
        let text = include_str!("../../../scenes/radial.toml");
        let own = MachineScene::from(Scene::parse(text).unwrap());
        let nothing = MachineScene::from(Scene::edited(text, [("solver", "{}")]).unwrap());
        let shaft = MachineScene::parse(include_str!("../../../scenes/shafts/pinion.toml")).unwrap();
        for scene in [&nothing, &shaft] {
            let [usual] = &usual_settings(scene)[..] else { panic!("it says nothing") };
            assert_eq!(usual.scene.solver(), scene.solver());
        }
        let [usual, said] = &usual_settings(&own)[..] else { panic!("it says its steps") };
        assert_eq!((usual.scene.solver(), said.scene.solver()), (nothing.solver(), own.solver()));
    }

    #[test]
    fn the_other_method_is_tried_where_it_knows_the_scene() {
        let tried = |scene: MachineScene| {
            let settings = numerical_settings(&scene);
            let of_method: Vec<_> =
                settings.iter().filter(|setting| setting.lever == Lever::Method).collect();
            assert!(of_method.iter().all(|setting| setting.scene.solver().method != scene.solver().method));
            of_method.len()
        };
        let text = include_str!("../../../scenes/radial.toml");
        assert_eq!(tried(Scene::parse(text).unwrap().into()), TOLERANCES.len());
        let apart = Scene::edited(text, [("effects.cage", "\"ideal\"")]).unwrap();
        assert_eq!(tried(apart.into()), 0);
        let shaft = include_str!("../../../scenes/shafts/pinion.toml");
        assert_eq!(tried(MachineScene::parse(shaft).unwrap()), TOLERANCES.len());
        let resting = shaft.replacen("name = \"left\"", "name = \"left\"\nlevel = \"equilibrium\"", 1);
        assert_eq!(tried(MachineScene::parse(&resting).unwrap()), 0);
    }
}
