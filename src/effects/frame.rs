//! A bearing whose frame moves, such as one in a planet carrier: inertia forces on balls, cage and races that forces move.
//! Forces on them are in [`super::moving_frame`].

use nalgebra::Vector3;
use serde::Deserialize;

use super::effect::{Effect, Info, InputRow};
use super::keys::keys;
use super::moving_frame::FrameMotion;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Acceleration, AngularAcceleration, AngularVelocity, Length};
use crate::schema::variable_units::{
    METRE_PER_SECOND_SQUARED, RADIAN_PER_SECOND, RADIAN_PER_SECOND_SQUARED, Unit,
};
use crate::schema::{Components, Group, SceneError, Schedule};

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

    /// Motion as a bearing of a machine sees it, at a place \[m] in the machine's axes; its x axis points along theirs (1), or
    /// against it (-1, by half a turn about z).
    #[must_use]
    pub fn at_bearing(&self, place: &Vector3<f64>, direction: f64) -> Self {
        let arm = self.arm() + place;
        let signs = [direction, direction, 1.0];
        let arm = [0, 1, 2].map(|i| Some(Length(signs[i] * arm[i])));
        if direction > 0.0 {
            return Self { arm, ..self.clone() };
        }
        Self {
            angular_velocity: self.angular_velocity.half_turned(),
            angular_acceleration: self.angular_acceleration.as_ref().map(Components::half_turned),
            acceleration: self.acceleration.half_turned(),
            arm,
        }
    }

    /// Does it turn, or may it by a table?
    pub fn turns(&self) -> bool {
        self.angular_velocity.largest() > 0.0
            || self.angular_acceleration.as_ref().is_some_and(|given| given.largest() > 0.0)
    }

    /// Checks the section of a machine, under a key of its own, as the numbers of a bearing's are.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, key: &str) -> Result<(), SceneError> {
        let each = |name: &str, range: Range, schedules: &[Schedule; 3]| {
            let mut axes = schedules.iter().zip(["x", "y", "z"]);
            axes.try_for_each(|(schedule, axis)| {
                let key = format!("{key}.{name}.{axis}");
                schedule.values().into_iter().try_for_each(|value| range.check(&key, value))
            })
        };
        each("angular_velocity", ANGULAR_VELOCITY, &self.angular_velocity.0)?;
        each("acceleration", ACCELERATION, &self.acceleration.0)?;
        if let Some(given) = &self.angular_acceleration {
            each("angular_acceleration", ANGULAR_ACCELERATION, &given.0)?;
        }
        self.arm().iter().try_for_each(|length| ARM.check(&format!("{key}.arm"), *length))
    }

    /// Quantities of it that are inputs: gravity, acceleration, angular velocity and, where it is given, angular acceleration; each with its
    /// name, unit, typical size, and what it is.
    pub fn inputs(&self) -> impl Iterator<Item = (usize, &'static str, Unit, f64, &'static str)> + use<> {
        let quantities = if self.angular_acceleration.is_some() { 4 } else { 3 };
        let row = |(quantity, (name, unit, nominal, _, what))| (quantity, name, unit, nominal, what);
        INPUTS.into_iter().enumerate().take(quantities).map(row)
    }

    /// All components that may change with time.
    pub fn schedules(&self) -> impl Iterator<Item = &Schedule> {
        let given = self.angular_acceleration.iter().flat_map(|given| &given.0);
        self.angular_velocity.0.iter().chain(&self.acceleration.0).chain(given)
    }

    /// Does a table give it?
    pub fn is_scripted(&self) -> bool {
        self.schedules().any(Schedule::is_scripted)
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
                range: None,
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
