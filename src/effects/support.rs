//! A flexible support between a race and its flange: the shaft or the housing whose pose is given.
//!
//! The race is a body of its own. With the displacement `d` of its origin from the flange's in the flange's axes, and the conformal
//! vector `c` of its rotation relative to the flange, the support stores `[d, c] K [d, c] / 2`; forces and moments are the
//! derivatives of that, so that no energy is made at any angle. Beside them act `-C` times the relative velocity and angular
//! velocity in the flange's axes. A flange that spins takes the axes of K and C with it.

use super::reports::SupportState;
use nalgebra::{Matrix6, Vector3, Vector6};

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::Estimate;
use super::keys::Keys;
use super::losses::Part;
use super::twin::Twin;
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::rotation::{from_quaternion, tangent_inverse_transposed, turn};
use crate::numerics::scalar::Scalar;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Inertia, Mass};
use crate::schema::variable_units::{METRE, RADIAN};
use crate::schema::{DirectionMatrix, Drive, SceneError, SupportSection};

/// [`Twin::unsettled`]: over 300 scenes of two seeds (cli/tests/studies/effect_verdicts.rs).
const UNSETTLED: &str = "without vibration, by which it changed the largest load in runs by up to 5.0 %";
const STIFFNESS: Range = Range::above(0.0, 1e15, "N/m or N m/rad");
const DAMPING: Range = Range::closed(0.0, 1e12, "N s/m or N m s/rad");
const MASS: Range = Range::above(0.0, 1e5, "kg");
const INERTIA: Range = Range::above(0.0, 1e5, "kg m2");
/// [-] asymmetry of a matrix over its entries that is rounding.
const ROUNDING: f64 = 1e-9;

/// The effect as a scene has it: the sections `support` of both races, inner first.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Sections; there with the effect only.
    pub sections: [Option<SupportSection>; 2],
}

impl Keys for Settings {
    // Its keys are those of the races.
    const NAMES: &'static [&'static str] = &[];

    fn read<'de, A: serde::de::MapAccess<'de>>(&mut self, _: &str, _: &mut A) -> Result<(), A::Error> {
        Ok(())
    }
}

/// A support as forces need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    stiffness: Matrix6<f64>,
    damping: Matrix6<f64>,
}

/// Motion of a race relative to its flange.
#[derive(Clone, Copy, Debug)]
pub struct Relative<S: Scalar> {
    /// \[m] displacement of the race's origin, world axes.
    pub displacement: Vector3<S>,
    /// \[rad] conformal vector of the race's rotation in the flange's axes.
    pub rotation: Vector3<S>,
    /// [m/s] velocity of the race's origin against the flange's material there, world axes.
    pub velocity: Vector3<S>,
    /// [rad/s] angular velocity of the race against the flange's, world axes.
    pub angular_velocity: Vector3<S>,
}

impl Relative<f64> {
    /// That of poses and twists.
    pub fn between((flange, flange_twist): (&Pose, &Twist), (race, twist): (&Pose, &Twist)) -> Self {
        let displacement = race.position - flange.position;
        Self {
            displacement,
            rotation: from_quaternion(&(flange.orientation.inverse() * race.orientation)),
            velocity: twist.velocity
                - flange_twist.velocity
                - flange_twist.angular_velocity.cross(&displacement),
            angular_velocity: twist.angular_velocity - flange_twist.angular_velocity,
        }
    }
}

/// Force of a support on its race, about the race's origin.
#[derive(Clone, Copy, Debug)]
pub struct Held<S: Scalar> {
    /// \[N] force, world axes.
    pub force: Vector3<S>,
    /// [N m] moment of the springs, in the race's own axes.
    pub elastic_moment: Vector3<S>,
    /// [N m] moment of the dampers, world axes.
    pub damping_moment: Vector3<S>,
}

impl SupportState {
    /// \[W] power that the flange's motion puts in.
    pub fn power_into(&self) -> f64 {
        -self.flange_twist.power(&self.wrench)
    }
}

/// Product of a symmetric matrix and two vectors, as two vectors.
fn product<S: Scalar>(matrix: &Matrix6<f64>, first: &Vector3<S>, second: &Vector3<S>) -> [Vector3<S>; 2] {
    let entry = |k: usize| if k < 3 { first[k] } else { second[k - 3] };
    let row = |i: usize| (0..6).fold(S::zero(), |sum, k| sum + entry(k).scale(matrix[(i, k)]));
    [0, 3].map(|from: usize| Vector3::from_fn(|i, _| row(from + i)))
}

impl Support {
    /// Force on its race.
    pub fn holds<S: Scalar>(&self, flange: &Pose, relative: &Relative<S>) -> Held<S> {
        let to_flange = flange.orientation.inverse();
        let seen = |v: &Vector3<S>| turn(&to_flange, v);
        let rotation = &relative.rotation;
        let [force, moment] = product(&self.stiffness, &seen(&relative.displacement), rotation);
        let [drag, damping_moment] =
            product(&self.damping, &seen(&relative.velocity), &seen(&relative.angular_velocity));
        Held {
            force: turn(&flange.orientation, &-(force + drag)),
            elastic_moment: -tangent_inverse_transposed(rotation, &moment),
            damping_moment: turn(&flange.orientation, &-damping_moment),
        }
    }

    /// Its state with the race at a pose and with a twist.
    pub fn state(
        &self,
        (flange, flange_twist): (&Pose, &Twist),
        (race, twist): (&Pose, &Twist),
    ) -> SupportState {
        let relative = Relative::between((flange, flange_twist), (race, twist));
        let displacement = relative.displacement;
        let turned = flange.orientation.inverse() * race.orientation;
        let held = self.holds(flange, &relative);
        let moment = race.orientation * held.elastic_moment + held.damping_moment;
        let seen = flange.orientation.inverse() * displacement;
        let [force, torque] = product(&self.stiffness, &seen, &relative.rotation);
        let [velocity, angular_velocity] =
            [relative.velocity, relative.angular_velocity].map(|v| flange.orientation.inverse() * v);
        let [drag, damping_moment] = product(&self.damping, &velocity, &angular_velocity);
        SupportState {
            flange: *flange,
            flange_twist: *flange_twist,
            wrench: Wrench { force: -held.force, moment: -moment - displacement.cross(&held.force) },
            displacement: seen,
            rotation: turned.scaled_axis(),
            energy: 0.5 * (seen.dot(&force) + relative.rotation.dot(&torque)),
            lost: velocity.dot(&drag) + angular_velocity.dot(&damping_moment),
        }
    }

    /// Stiffness and damping along and about the flange's axes.
    pub fn matrices(&self) -> [&Matrix6<f64>; 2] {
        [&self.stiffness, &self.damping]
    }

    /// Stiffness along and about the flange's axes, but for the turn about x: order x, y, z, ry, rz.
    pub fn stiffness(&self) -> nalgebra::SMatrix<f64, 5, 5> {
        let place = |i: usize| if i < 3 { i } else { i + 1 };
        nalgebra::SMatrix::from_fn(|i, k| self.stiffness[(place(i), place(k))])
    }
}

impl From<&SupportSection> for Support {
    fn from(section: &SupportSection) -> Self {
        Self { stiffness: section.stiffness.0, damping: section.damping.0 }
    }
}

/// A number of the section of one race.
macro_rules! place {
    ($race:literal, |$section:ident| $number:expr) => {
        |s: &mut Settings| Place::Value(s.sections[$race].as_mut().map(|$section| $number))
    };
}

fn diagonal(settings: &Settings, race: usize, of: fn(&SupportSection) -> Vec<f64>) -> Place<'static> {
    Place::Read(settings.sections[race].as_ref().map(of).unwrap_or_default())
}

const RACES: [&str; 2] = ["inner", "outer"];

/// [N/m, N m/rad] support that the estimate is for, where the scene gives none: a stiff one.
const TYPICAL_STIFFNESS: [f64; 2] = [1e9, 1e7];

fn typical() -> SupportSection {
    let [force, moment] = TYPICAL_STIFFNESS;
    let mut stiffness = DirectionMatrix::default();
    stiffness.0 = Matrix6::from_diagonal(&Vector6::new(force, force, force, moment, moment, moment));
    // A mass changes nothing at a settled state.
    SupportSection {
        stiffness,
        damping: DirectionMatrix::default(),
        mass: Mass(1.0),
        inertia: [Inertia(1e-3); 3],
    }
}

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.support",
    description: "power lost in the dampers of flexible supports",
    words: "dampers of supports",
    is_of: |effects| effects.support.sections.iter().any(Option::is_some),
    get: |losses| losses.support,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "support",
        adds: "a flexible support between a race and its flange, whose pose is given: stiffness and damping 6 x 6, and the race's \
               own mass",
        states: "pose, velocity and angular velocity of the race",
        price: "76 % of a step (thrust case, outer race; a body more)",
        source: "linear springs and dampers about the flange's axes, with the exact potential of a finite rotation",
        example: "[effects]\ncreep = \"saturated\"\n[outer.support]\nstiffness = [5e7, 1e8, 1e8, 5e4, 5e4, 5e4]\nmass = 0.12\n\
                  inertia = [5e-5, 3e-5, 3e-5]\n",
    };
    const ESTIMATE: &'static str = "settled states with and without it; 1000 N/um where it is off";

    const NUMBERS: &'static [Number<Self>] = &[
        Number::checked("inner.support.stiffness", STIFFNESS, |s| diagonal(s, 0, |x| x.stiffness.diagonal())),
        Number::checked("inner.support.damping", DAMPING, |s| diagonal(s, 0, |x| x.damping.diagonal())),
        Number::fixed(
            "inner.support.mass",
            MASS,
            "mass of the inner race on its support",
            place!(0, |x| &mut x.mass.0),
        ),
        Number::checked("inner.support.inertia", INERTIA, |s| {
            diagonal(s, 0, |x| x.inertia.map(|moment| moment.0).to_vec())
        }),
        Number::checked("outer.support.stiffness", STIFFNESS, |s| diagonal(s, 1, |x| x.stiffness.diagonal())),
        Number::checked("outer.support.damping", DAMPING, |s| diagonal(s, 1, |x| x.damping.diagonal())),
        Number::fixed(
            "outer.support.mass",
            MASS,
            "mass of the outer race on its support",
            place!(1, |x| &mut x.mass.0),
        ),
        Number::checked("outer.support.inertia", INERTIA, |s| {
            diagonal(s, 1, |x| x.inertia.map(|moment| moment.0).to_vec())
        }),
    ];

    fn setting(&self) -> Option<String> {
        let of = |(race, section): (&str, &Option<SupportSection>)| {
            section
                .as_ref()
                .map(|section| format!("{race} race, {:?} N/m and N m/rad", section.stiffness.diagonal()))
        };
        let all: Vec<String> = RACES.into_iter().zip(&self.sections).filter_map(of).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        for ((race, drive), section) in RACES.into_iter().zip(setup.drives).zip(&self.sections) {
            let Some(section) = section else {
                continue;
            };
            if !matches!(drive, Drive::Fixed | Drive::Pose) {
                let why = format!(
                    "allowed with {race}.drive = \"fixed\" or \"pose\", which then move its flange: a race under a wrench or on \
                     a hinge has none"
                );
                return Err(SceneError::conflict(format!("{race}.support"), why));
            }
            for (key, matrix) in [("stiffness", &section.stiffness.0), ("damping", &section.damping.0)] {
                let key = format!("{race}.support.{key}");
                let symmetric = (matrix - matrix.transpose()).amax() <= ROUNDING * matrix.amax();
                if !symmetric {
                    return Err(SceneError::conflict(key, "the matrix must be symmetric"));
                }
                // Over the roots of its diagonal the matrix has no units.
                let root = matrix.diagonal().map(|x| if x > 0.0 { 1.0 / x.sqrt() } else { 1.0 });
                let scaled = Matrix6::from_diagonal(&root) * matrix * Matrix6::from_diagonal(&root);
                let least = scaled.symmetric_eigenvalues().min();
                let allowed = if key.ends_with("stiffness") { least > ROUNDING } else { least >= -ROUNDING };
                if !allowed {
                    let why = format!(
                        "the matrix must not give energy: its smallest eigenvalue over its diagonal is {least:.3e}, allowed are \
                         positive ones (of damping also 0)"
                    );
                    return Err(SceneError::conflict(key, why));
                }
            }
        }
        Ok(())
    }

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        let on = self.sections.iter().any(Option::is_some);
        let write = "[inner.support] or [outer.support]; the stiffness around the bearing is not known here";
        // Races that forces move rest on nothing.
        let Some(race) = [1, 0].into_iter().find(|race| on || estimate.flanged[*race]) else { return vec![] };
        let twin = Twin::new("support", "support", on, move |effects| match on {
            true => effects.support.sections = [None, None],
            false => effects.support.sections[race] = Some(typical()),
        });
        let words = if on { "" } else { "a support of 1000 N/um and 10 N m/mrad" };
        // A settled displacement of 0.2 % went with 5 % of the largest load: what a race rests on changes how it vibrates.
        vec![Twin { unsettled: Some(UNSETTLED), ..twin.taken_as(words).written(write) }]
    }

    fn rows(&self) -> Vec<Row> {
        let mut rows = vec![];
        for (race, (name, _)) in
            RACES.into_iter().zip(&self.sections).enumerate().filter(|(_, (_, s))| s.is_some())
        {
            for (quantity, unit, nominal, what) in [
                ("displacement", METRE, 1e-5, "displacement of the race from its flange"),
                ("rotation", RADIAN, 1e-4, "rotation vector of the race relative to its flange"),
            ] {
                for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
                    let translates = quantity == "displacement";
                    rows.push(Row {
                        name: format!("{name}.support.{quantity}.{axis}"),
                        unit,
                        nominal,
                        description: format!("{what}, {axis} component along the flange's axes, {name} race"),
                        get: Getter::new(move |reports| {
                            let of = |state: &SupportState| {
                                if translates { state.displacement[i] } else { state.rotation[i] }
                            };
                            reports.supports[race].map_or(0.0, of)
                        }),
                    });
                }
            }
        }
        rows
    }
}
