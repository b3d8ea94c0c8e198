//! Report of every ball.

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use super::reports::{BallOutput, ContactOutput};
use crate::schema::variable_units::{
    METRE, NEWTON, NEWTON_METRE, ONE, PASCAL, PER_METRE, RADIAN, RADIAN_PER_SECOND, Unit, WATT,
};

keys! {
    /// Does an FMU report every ball (`ball[j].*`)? Tables of results always do.
    "per_ball_outputs" => on: bool = false,
}

/// A row of a ball; balls count from 0 here and from 1 in names.
pub(super) fn ball_row(
    ball: usize,
    name: &str,
    unit: Unit,
    nominal: f64,
    description: String,
    get: impl Fn(&BallOutput) -> f64 + Send + Sync + 'static,
) -> Row {
    Row {
        name: format!("ball[{}].{name}", ball + 1),
        unit,
        nominal,
        description,
        get: Getter::new(move |reports| reports.balls.get(ball).map_or(0.0, &get)),
    }
}

/// Motion of a ball.
pub(super) fn motion_rows(ball: usize) -> Vec<Row> {
    let number = ball + 1;
    vec![
        ball_row(ball, "azimuth", RADIAN, 1.0, format!("azimuth from +y towards +z of ball {number}"), |b| {
            b.azimuth
        }),
        ball_row(
            ball,
            "orbital_speed",
            RADIAN_PER_SECOND,
            100.0,
            format!("orbital speed of ball {number}"),
            |b| b.orbital_speed,
        ),
    ]
}

type Contact = fn(&BallOutput) -> &ContactOutput;
type FromContact = fn(&ContactOutput) -> f64;
type FromBall = fn(&BallOutput) -> f64;

/// Quantities of a contact with a race: name, unit, typical size, what it is, and its value.
const QUANTITIES: [(&str, Unit, f64, &str, FromContact); 10] = [
    ("load", NEWTON, 100.0, "normal load", |c| c.load),
    ("contact_angle", RADIAN, 0.1, "contact angle", |c| c.contact_angle),
    ("creepage_longitudinal", ONE, 1e-3, "longitudinal creepage", |c| c.creepage_longitudinal),
    ("creepage_lateral", ONE, 1e-3, "lateral creepage", |c| c.creepage_lateral),
    ("creepage_spin", PER_METRE, 10.0, "spin creepage", |c| c.creepage_spin),
    ("force_longitudinal", NEWTON, 1.0, "longitudinal creep force on the ball", |c| c.force_longitudinal),
    ("force_lateral", NEWTON, 1.0, "lateral creep force on the ball", |c| c.force_lateral),
    ("spin_moment", NEWTON_METRE, 1e-3, "spin moment on the ball", |c| c.spin_moment),
    ("power", WATT, 0.1, "power lost to friction", |c| c.power),
    ("peak_pressure", PASCAL, 1e9, "peak pressure", |c| c.peak_pressure),
];

/// Contacts of a ball with the races.
pub(super) fn contact_rows(ball: usize) -> Vec<Row> {
    let races: [(&str, Contact); 2] = [("inner", |b| &b.inner), ("outer", |b| &b.outer)];
    let mut rows = vec![];
    for (race, contact) in races {
        for (quantity, unit, nominal, what, get) in QUANTITIES {
            let description = format!("{what} of ball {} and the {race} race", ball + 1);
            let name = format!("{race}.{quantity}");
            rows.push(ball_row(ball, &name, unit, nominal, description, move |b| get(contact(b))));
        }
    }
    rows
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.per_ball_outputs",
        adds: "report of every ball and its contacts",
        states: "none",
        source: "Bovet et al. 2013, sections 3.2 and 5",
        price: "none in a step",
        example: "[effects]\nper_ball_outputs = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        if !self.on {
            return vec![];
        }
        let number = ball + 1;
        let spins: [(&str, &str, FromBall); 3] = [
            ("axial", "along the outer race's axis", |b| b.spin.x),
            ("radial", "radially away from the outer race's axis", |b| b.spin.y),
            ("tangential", "along the orbit", |b| b.spin.z),
        ];
        let mut rows: Vec<Row> = spins
            .into_iter()
            .map(|(name, along, get)| {
                let description = format!("angular velocity of ball {number} {along}");
                ball_row(ball, &format!("spin.{name}"), RADIAN_PER_SECOND, 1000.0, description, get)
            })
            .collect();
        let races: [(&str, Contact); 2] = [("inner", |b| &b.inner), ("outer", |b| &b.outer)];
        let axes: [(&str, FromContact); 2] =
            [("rolling", |c| c.semi_axis_rolling), ("transverse", |c| c.semi_axis_transverse)];
        for (race, contact) in races {
            for (axis, get) in axes {
                let description =
                    format!("{axis} semi-axis of the contact ellipse of ball {number} and the {race} race");
                let name = format!("{race}.semi_axis_{axis}");
                rows.push(ball_row(ball, &name, METRE, 1e-4, description, move |b| get(contact(b))));
            }
        }
        rows
    }
}
