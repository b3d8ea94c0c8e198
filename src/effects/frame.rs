//! A bearing whose frame moves, such as one in a planet carrier: inertia forces on balls, cage and races that forces move.
//!
//! Every place and velocity of a scene is then one seen from that frame. With the acceleration `a` of a point of the frame,
//! the arm `e` from there to the frame's origin, its angular velocity `W` and their rates of change, a body of mass m at `r`
//! with the velocity `v` feels `m (g - a - W' x (r + e) - W x (W x (r + e)) - 2 W x v)`; and where it turns with `w` relative to
//! the frame, the moment of momentum that counts is `J (w + W)`.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use super::effect::{Effect, Info, InputRow};
use super::keys::keys;
use crate::numerics::scalar::{Scalar, cross};
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Acceleration, AngularAcceleration, AngularVelocity, Length};
use crate::schema::variable_units::{
    METRE_PER_SECOND_SQUARED, RADIAN_PER_SECOND, RADIAN_PER_SECOND_SQUARED, Unit,
};
use crate::schema::{Components, Group, Schedule};

const ACCELERATION: Range = Range::closed(-1e6, 1e6, "m/s2");
const ANGULAR_VELOCITY: Range = Range::closed(-1e5, 1e5, "rad/s");
const ANGULAR_ACCELERATION: Range = Range::closed(-1e9, 1e9, "rad/s2");
const ARM: Range = Range::closed(-1e3, 1e3, "m");

/// The section `[effects.frame]`; components along the frame's own axes.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FrameSection {
    /// [rad/s] angular velocity of the frame, each component constant or a table.
    pub angular_velocity: Components<AngularVelocity>,
    /// [rad/s2] its angular acceleration; that by which the angular velocity changes if not given.
    pub angular_acceleration: Option<Components<AngularAcceleration>>,
    /// [m/s2] acceleration of the point that the arm begins at.
    pub acceleration: Components<Acceleration>,
    /// \[m] from that point to the origin of the frame; a carrier has that point on its axis.
    pub arm: [Option<Length>; 3],
}

keys! {
    /// Motion of the frame; there with the effect only.
    "frame" => section: Option<FrameSection> = None,
}

/// How the frame of a bearing moves at an instant, and the gravity in it; components along the frame's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameMotion {
    /// [m/s2] gravity.
    pub gravity: Vector3<f64>,
    /// [m/s2] acceleration of the point that the arm begins at.
    pub acceleration: Vector3<f64>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<f64>,
    /// [rad/s2] angular acceleration.
    pub angular_acceleration: Vector3<f64>,
}

impl FrameMotion {
    /// All components as one vector, in the order of the fields.
    pub fn components(&self) -> SVector<f64, 12> {
        let vectors = [self.gravity, self.acceleration, self.angular_velocity, self.angular_acceleration];
        SVector::from_fn(|i, _| vectors[i / 3][i % 3])
    }

    /// The motion of these components.
    pub fn of_components(all: &SVector<f64, 12>) -> Self {
        let vector = |first: usize| Vector3::from_fn(|i, _| all[first + i]);
        Self {
            gravity: vector(0),
            acceleration: vector(3),
            angular_velocity: vector(6),
            angular_acceleration: vector(9),
        }
    }

    fn vector(&self, quantity: usize) -> &Vector3<f64> {
        match quantity {
            0 => &self.gravity,
            1 => &self.acceleration,
            2 => &self.angular_velocity,
            _ => &self.angular_acceleration,
        }
    }

    fn vector_mut(&mut self, quantity: usize) -> &mut Vector3<f64> {
        match quantity {
            0 => &mut self.gravity,
            1 => &mut self.acceleration,
            2 => &mut self.angular_velocity,
            _ => &mut self.angular_acceleration,
        }
    }
}

/// The motion of the frame as an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameInputs {
    /// As set last.
    pub motion: FrameMotion,
    /// Rates of change \[1/s] of the components, where they are known.
    pub rate: FrameMotion,
    /// Is the angular acceleration given? If not, it is that by which the angular velocity changes.
    pub accelerates: bool,
}

/// A frame that moves, as forces need it, in any axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingFrame<S: Scalar = f64> {
    /// \[m] from the point whose acceleration is given to where places are counted from.
    pub arm: Vector3<S>,
    /// [m/s2] acceleration of that point.
    pub acceleration: Vector3<S>,
    /// [rad/s] angular velocity.
    pub turn: Vector3<S>,
    /// [rad/s2] angular acceleration.
    pub change: Vector3<S>,
}

impl<S: Scalar> MovingFrame<S> {
    /// [m/s2] force of inertia over the mass of a body at a place, with a velocity, both seen from the frame.
    #[inline]
    pub fn field(&self, position: &Vector3<S>, velocity: &Vector3<S>) -> Vector3<S> {
        let from_point = position + self.arm;
        let around = cross(&self.turn, &from_point) + velocity.map(|c| c.scale(2.0));
        -(self.acceleration + cross(&self.change, &from_point) + cross(&self.turn, &around))
    }
}

impl MovingFrame {
    /// That of a motion, with an arm \[m].
    pub fn new(motion: &FrameMotion, arm: Vector3<f64>) -> Self {
        let FrameMotion { acceleration, angular_velocity, angular_acceleration, .. } = *motion;
        Self { arm, acceleration, turn: angular_velocity, change: angular_acceleration }
    }

    /// The same with each vector seen otherwise: in other axes, or as numbers that have derivatives.
    #[inline]
    pub fn seen<S: Scalar>(&self, see: impl Fn(&Vector3<f64>) -> Vector3<S>) -> MovingFrame<S> {
        MovingFrame {
            arm: see(&self.arm),
            acceleration: see(&self.acceleration),
            turn: see(&self.turn),
            change: see(&self.change),
        }
    }

    /// [N m] moment of inertia forces on a body with these principal moments of inertia [kg m2] and a rate [rad/s] relative to
    /// the frame, in its own axes. `to_body` turns a vector of the frame into these axes.
    #[inline]
    pub fn moment<S: Scalar>(
        &self,
        inertia: &Vector3<f64>,
        rate: &Vector3<S>,
        to_body: impl Fn(&Vector3<f64>) -> Vector3<S>,
    ) -> Vector3<S> {
        let turn = to_body(&self.turn);
        let change = to_body(&self.change) - cross(rate, &turn);
        let momentum = |rate: &Vector3<S>| Vector3::from_fn(|i, _| rate[i].scale(inertia[i]));
        let whole = rate + turn;
        // The part `rate x J rate` is there without a moving frame, too.
        -(momentum(&change) + cross(&whole, &momentum(&turn)) + cross(&turn, &momentum(rate)))
    }
}

impl FrameSection {
    /// \[m] the arm.
    pub fn arm(&self) -> Vector3<f64> {
        Vector3::from(self.arm.map(|component| component.map_or(0.0, |length| length.0)))
    }

    /// Motion at a time \[s], without gravity.
    pub fn at(&self, time: f64) -> FrameMotion {
        FrameMotion {
            gravity: Vector3::zeros(),
            acceleration: self.acceleration.at(time),
            angular_velocity: self.angular_velocity.at(time),
            angular_acceleration: match &self.angular_acceleration {
                Some(given) => given.at(time),
                None => self.angular_velocity.slope(time),
            },
        }
    }

    /// All components that may change with time.
    pub fn schedules(&self) -> impl Iterator<Item = &Schedule> {
        let given = self.angular_acceleration.iter().flat_map(|given| &given.0);
        self.angular_velocity.0.iter().chain(&self.acceleration.0).chain(given)
    }

    /// Does a table give it?
    pub fn is_scripted(&self) -> bool {
        self.schedules().any(Schedule::is_table)
    }

    /// \[m/s2] largest size of the acceleration of the frame's origin, an estimate for scales.
    pub fn largest_acceleration(&self) -> f64 {
        let speed = self.angular_velocity.largest();
        self.acceleration.largest() + speed * speed * self.arm().norm()
    }
}

/// A component of a key of the section, if there is one.
macro_rules! place {
    ($field:ident, $component:literal) => {
        |s: &mut Settings| match &mut s.section {
            Some(section) => Place::Schedule(&mut section.$field.0[$component]),
            None => Place::Read(vec![]),
        }
    };
}

/// A component of the angular acceleration, if it is given.
fn given(settings: &mut Settings, component: usize) -> Place<'_> {
    match settings.section.as_mut().and_then(|section| section.angular_acceleration.as_mut()) {
        Some(given) => Place::Schedule(&mut given.0[component]),
        None => Place::Read(vec![]),
    }
}

fn arm(settings: &mut Settings, component: usize) -> Place<'_> {
    let place = settings.section.as_mut().and_then(|section| section.arm[component].as_mut());
    Place::Value(place.map(|length| &mut length.0))
}

/// Inputs: name, unit, typical size, small change, and what it is.
const INPUTS: [(&str, Unit, f64, f64, &str); 4] = [
    ("gravity", METRE_PER_SECOND_SQUARED, 10.0, 1e-2, "acceleration of gravity"),
    ("acceleration", METRE_PER_SECOND_SQUARED, 10.0, 1e-2, "acceleration of the bearing's frame"),
    ("angular_velocity", RADIAN_PER_SECOND, 10.0, 1e-3, "angular velocity of the bearing's frame"),
    (
        "angular_acceleration",
        RADIAN_PER_SECOND_SQUARED,
        10.0,
        1e-2,
        "angular acceleration of the bearing's frame",
    ),
];

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.frame",
        adds: "a frame of the bearing that moves (planet carrier, vehicle): forces of inertia on balls, cage and races that forces \
               move, and gravity as an input",
        states: "none",
        price: "14 % of a step (thrust case)",
        source: "mechanics of relative motion (Coriolis 1835; Landau and Lifshitz, Mechanics, section 39)",
        example: "[effects]\nframe = { angular_velocity = [\"200 rpm\", 0, 0], arm = [0, \"0.15 m\", 0] }\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::checked("effects.frame.angular_velocity.x", ANGULAR_VELOCITY, place!(angular_velocity, 0)),
        Number::checked("effects.frame.angular_velocity.y", ANGULAR_VELOCITY, place!(angular_velocity, 1)),
        Number::checked("effects.frame.angular_velocity.z", ANGULAR_VELOCITY, place!(angular_velocity, 2)),
        Number::checked("effects.frame.acceleration.x", ACCELERATION, place!(acceleration, 0)),
        Number::checked("effects.frame.acceleration.y", ACCELERATION, place!(acceleration, 1)),
        Number::checked("effects.frame.acceleration.z", ACCELERATION, place!(acceleration, 2)),
        Number::checked("effects.frame.angular_acceleration.x", ANGULAR_ACCELERATION, |s| given(s, 0)),
        Number::checked("effects.frame.angular_acceleration.y", ANGULAR_ACCELERATION, |s| given(s, 1)),
        Number::checked("effects.frame.angular_acceleration.z", ANGULAR_ACCELERATION, |s| given(s, 2)),
        Number::fixed(
            "effects.frame.arm.x",
            ARM,
            "arm from the given point to the frame's origin along x",
            |s| arm(s, 0),
        ),
        Number::fixed(
            "effects.frame.arm.y",
            ARM,
            "arm from the given point to the frame's origin along y",
            |s| arm(s, 1),
        ),
        Number::fixed(
            "effects.frame.arm.z",
            ARM,
            "arm from the given point to the frame's origin along z",
            |s| arm(s, 2),
        ),
    ];

    fn setting(&self) -> Option<String> {
        let section = self.section.as_ref()?;
        let FrameMotion { acceleration, angular_velocity, .. } = section.at(0.0);
        let list = |v: &Vector3<f64>| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        let [turn, moves] = [list(&angular_velocity), list(&acceleration)];
        let arm = list(&section.arm());
        Some(format!("turns at {turn} rad/s about a point {arm} m away that accelerates with {moves} m/s2"))
    }

    fn inputs(&self) -> Vec<InputRow> {
        let Some(section) = &self.section else {
            return vec![];
        };
        let quantities = if section.angular_acceleration.is_some() { 4 } else { 3 };
        let row = |index: usize| {
            let (quantity, component) = (index / 3, index % 3);
            let (name, unit, nominal, change, what) = INPUTS[quantity];
            let axis = ["x", "y", "z"][component];
            InputRow {
                name: format!("frame.{name}.{axis}"),
                unit,
                nominal,
                change,
                description: format!("{what}, {axis} component along the frame's own axes"),
                group: Group::Frame,
                place: index,
                get: |inputs, index| inputs.frame.motion.vector(index / 3)[index % 3],
                rate: |inputs, index| inputs.frame.rate.vector(index / 3)[index % 3],
                set: |inputs, index, value, rate| {
                    inputs.frame.motion.vector_mut(index / 3)[index % 3] = value;
                    inputs.frame.rate.vector_mut(index / 3)[index % 3] = rate;
                },
            }
        };
        (0..3 * quantities).map(row).collect()
    }
}
