//! Slip under load of balls that enter the load zone.
//!
//! A ball loses speed where only centrifugal force holds it, and slips until friction has brought it back to rolling after it has come to where
//! the races carry their load. Its load grows meanwhile: load times slip speed has a maximum there. Where that is large, films collapse and
//! surfaces smear (Hamer, Sayles and Ioannides 1991, The collapse of sliding micro-EHL films by plastic extrusion, ASME Journal of
//! Tribology 113, recalled). How large is too large depends on steel, oil and surfaces; nothing is told of that.

use nalgebra::Vector3;

use crate::contact::linear_theory::Creepage;
use crate::forces::Contacts;
use crate::model::bodies::Race;
use crate::model::state::State;

/// [-] least sum of the directions of all loads over the sum of the loads of a bearing with a load zone: under thrust alone no ball enters one.
const ZONE: f64 = 1e-3;

/// [-] place on the long axis of the ellipse, over its semi-axis, where a bent groove rolls that no force drives, squared: (2 sin 10 degrees)^2, as half
/// of the load of such a contact slips forwards.
const ROLLS: f64 = 0.120_614_758;

/// \[W] largest product of normal load and slip speed of a contact with either race, of the balls on their way to where the inner race presses most.
/// The slip is that beyond free rolling, of which bent grooves have some in the middle. There is no friction coefficient in it: what
/// becomes heat is less.
pub(super) fn slip_load(state: &State, contacts: &Contacts) -> f64 {
    let outer = state.race(Race::Outer);
    let axis = outer.pose.orientation * Vector3::x();
    let (mut whole, mut direction) = (0.0, Vector3::zeros());
    for of_ball in &contacts.balls {
        let inner = &of_ball.raceways.inner;
        whole += inner.load;
        direction += inner.geometry.radial * inner.load;
    }
    if direction.norm() <= ZONE * whole {
        return 0.0;
    }
    let mut largest: f64 = 0.0;
    for (ball, of_ball) in state.balls.iter().zip(&contacts.balls) {
        // Positive where a positive turn about the axis leads to the load.
        let ahead = axis.dot(&of_ball.raceways.inner.geometry.radial.cross(&direction));
        if ahead * ball.orbital_speed(outer) > 0.0 {
            for contact in Race::BOTH.map(|race| &of_ball.raceways[race]) {
                let Creepage { longitudinal, lateral, curvature, .. } = contact.creepage;
                let side = contact.semi_axes[1] * contact.geometry.approach.max(0.0).sqrt();
                let bent = ROLLS * side * side * curvature.unwrap_or(0.0);
                let slip = (longitudinal - bent).hypot(lateral) * contact.rolling_speed;
                largest = largest.max(contact.load * slip);
            }
        }
    }
    largest
}
