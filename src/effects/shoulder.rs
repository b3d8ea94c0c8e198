//! Report of loads beyond the shoulders of the races ([`crate::contact::shoulder`]).

use super::effect::{Effect, Getter, Info, Row};
use super::keys::keys;
use super::per_ball::ball_row;
use super::reports::{BallOutput, ContactOutput};
use crate::contact::shoulder::largest_share;
use crate::schema::variable_units::ONE;

keys! {
    /// Are they reported (`shoulder.*`)? Contacts that lie beyond a shoulder are refused all the same.
    "shoulder_outputs" => on: bool = false,
}

type Contact = fn(&BallOutput) -> &ContactOutput;

/// The contact of a ball with each race.
const RACES: [(&str, Contact); 2] = [("inner", |ball| &ball.inner), ("outer", |ball| &ball.outer)];

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.shoulder_outputs",
        adds: "report of the share of load that contact ellipses have beyond the shoulders of the races",
        states: "none",
        source: "Hertz's pressure, integrated beyond the edge of the groove",
        example: "[effects]\nshoulder_outputs = true\n",
    };

    fn setting(&self) -> Option<String> {
        self.on.then(|| "on".into())
    }

    fn rows(&self) -> Vec<Row> {
        let row = |(race, contact): (&str, Contact)| Row {
            name: format!("shoulder.{race}.share"),
            unit: ONE,
            nominal: 0.1,
            description: format!("largest share of a ball's load beyond the shoulders of the {race} race"),
            get: Getter::new(move |reports| {
                let contacts = reports.balls.iter().map(contact);
                largest_share(contacts.map(|contact| (contact.load, contact.shoulder_share)))
            }),
        };
        if self.on { RACES.into_iter().map(row).collect() } else { vec![] }
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
