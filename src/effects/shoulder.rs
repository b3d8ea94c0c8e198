//! Shoulders where the scene gives none, and the report of loads beyond them ([`crate::contact::shoulder`]).

use std::f64::consts::{FRAC_PI_2, PI};

use super::effect::{Effect, Getter, Info, Row};
use super::estimate::{Estimate, Standing, Verdict, digits, percent};
use super::keys::keys;
use super::limits::{Limit, Quantity};
use super::per_ball::ball_row;
use super::reports::{BallOutput, ContactOutput, Reports};
use crate::contact::shoulder::{largest_share, least_margin};
use crate::schema::variable_units::{ONE, RADIAN};

/// [-] height of a shoulder over the ball diameter, where it is not given. Bearings of published cases roll within it (a 218 at
/// 15,000 rpm at 57 degrees, one of the reference cases at 60, the end is at 65); under 0.25 they would not.
pub const DEFAULT_HEIGHT: f64 = 0.3;
/// [-] where the groove of an angular-contact bearing ends on the side that thrust does not load, over the free contact angle:
/// it keeps balls that cross the bottom of the groove under tilt or centrifugal force, and carries no thrust, as the other flank
/// would meet the ball beyond.
const LOW_SHOULDER: f64 = 1.0;
/// \[rad] a high shoulder reaches at least this far beyond the free contact angle.
const REACH: f64 = 10.0 * PI / 180.0;

/// \[rad] contact angles at which a groove ends where the scene gives no shoulders, on the side that thrust loads and on the other:
/// of a free contact angle \[rad] (0 for a bearing given by its clearance), and the end under a shoulder of the default height \[rad].
pub fn default_ends(free: f64, high: f64) -> [f64; 2] {
    let loaded = high.max(free + REACH);
    // Washers that face along the axis have no shoulder at all.
    let loaded = if loaded < FRAC_PI_2 { loaded } else { PI };
    [loaded, if free > 0.0 { LOW_SHOULDER * free } else { loaded }]
}

keys! {
    /// Are shares of load beyond shoulders, and margins to them, reported (`shoulder.*`)? Contacts that lie beyond a shoulder are refused all the same.
    "shoulder_outputs" => on: bool = false,
}

const KEY: &str = "effects.shoulder_outputs";
/// Subject of its estimate.
pub const SUBJECT: &str = "shoulders";

/// Its limit.
pub static LIMIT: Limit = Limit {
    title: "over shoulders",
    quantities: &[
        Quantity {
            name: "over inner shoulders",
            column: "over_inner_shoulders",
            unit: ONE,
            get: |reports| share(reports, RACES[0].1),
            warning: Some(|share| beyond(share, RACES[0].0)),
        },
        Quantity {
            name: "over outer shoulders",
            column: "over_outer_shoulders",
            unit: ONE,
            get: |reports| share(reports, RACES[1].1),
            warning: Some(|share| beyond(share, RACES[1].0)),
        },
    ],
    shown: (100.0, 2),
    line: |shares| match shares {
        [inner, outer] => format!("inner up to {inner} %, outer up to {outer} % of a load"),
        _ => String::new(),
    },
    subject: Some(SUBJECT),
};

/// [-] largest share of a ball's load beyond the shoulders of a race.
fn share(reports: &Reports<'_>, contact: Contact) -> f64 {
    let contacts = reports.balls.iter().map(contact);
    largest_share(contacts.map(|contact| (contact.load, contact.shoulder_share)))
}

fn beyond(share: f64, race: &str) -> String {
    format!("up to {:.2} % of a load is beyond the {race} shoulders", 100.0 * share)
}

type Contact = fn(&BallOutput) -> &ContactOutput;

/// The contact of a ball with each race.
const RACES: [(&str, Contact); 2] = [("inner", |ball| &ball.inner), ("outer", |ball| &ball.outer)];

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: KEY,
        adds: "report of the share of load that contact ellipses have beyond the shoulders of the races",
        states: "none",
        source: "Hertz's pressure, integrated beyond the edge of the groove",
        price: "none in a step",
        example: "[effects]\nshoulder_outputs = true\n",
    };
    const ESTIMATE: &'static str = "least distance of a contact ellipse from a shoulder";

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn matters(&self, estimate: &Estimate) -> Vec<Verdict> {
        let margin = estimate.shoulder_margin;
        let angle = digits(margin.abs().to_degrees());
        let sentence = if margin < 0.0 {
            let share = percent(estimate.shoulder_share);
            format!("a contact ellipse reaches {angle} deg over a shoulder, with up to {share} of its load")
        } else {
            format!("contact ellipses end {angle} deg before the nearest shoulder")
        };
        vec![Verdict {
            key: Some(KEY),
            unit: "rad",
            matters: margin < 0.0,
            auto: Some(KEY),
            ..Verdict::new(
                (SUBJECT, "margin"),
                if self.on { Standing::On } else { Standing::Off },
                (margin, 0.0),
                sentence,
                "[effects] shoulder_outputs = true reports it; loads stay those of whole ellipses",
            )
        }]
    }

    fn switch(&mut self, key: &str, on: bool) {
        if key == KEY {
            self.on = on;
        }
    }

    fn rows(&self) -> Vec<Row> {
        let row = |(race, contact): (&str, Contact)| Row {
            name: format!("shoulder.{race}.share"),
            unit: ONE,
            nominal: 0.1,
            description: format!("largest share of a ball's load beyond the shoulders of the {race} race"),
            get: Getter::new(move |reports| share(reports, contact)),
        };
        let margin = |(race, contact): (&str, Contact)| Row {
            name: format!("shoulder.{race}.margin"),
            unit: RADIAN,
            nominal: 0.1,
            description: format!(
                "smallest distance of a ball's contact ellipse from a shoulder of the {race} race; negative where it is cut"
            ),
            get: Getter::new(move |reports| {
                let contacts = reports.balls.iter().map(contact);
                least_margin(contacts.map(|contact| (contact.load, contact.shoulder_margin)))
            }),
        };
        let rows = RACES.into_iter().map(row).chain(RACES.into_iter().map(margin));
        if self.on { rows.collect() } else { vec![] }
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        let row = |(race, contact): (&str, Contact)| {
            let description =
                format!("share of the load of ball {} beyond the shoulders of the {race} race", ball + 1);
            ball_row(ball, &format!("{race}.shoulder_share"), ONE, 0.1, description, move |ball| {
                contact(ball).shoulder_share
            })
        };
        if self.on { RACES.into_iter().map(row).collect() } else { vec![] }
    }
}
