//! Bearings at rest, where nothing is said about steps: what their steps do differently.

use crate::contact::REGULARISATION_SPEED;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::state::State;

/// [-] local error that is allowed in a bearing whose races do not turn against each other, over that of one that runs. There friction does
/// not sum up what a ball has missed of its way: loads alone feel it, at once. A ring that goes on ringing after a blow is wrong by 1.8 % of
/// the largest load with the damping below (1.4 % without it, 0.4 % with 1 in place of 10); 50 makes it 3.5 %, more than is promised.
pub const LOCAL_ERROR: f64 = 10.0;

/// [-] least damping of the HHT scheme. Contacts that stick are dampers thousands of times stiffer than those that roll, and HHT makes the
/// acceleration of what they hold change its sign from step to step: by -(1 - gamma)/gamma, which is -0.82 with the usual 0.05 and -0.67 with this
/// one. With -0.82 it lasts, errors and first guesses see it, and under an alternating load without a cage steps were half as long. More damping
/// hardly saves more, and takes more away of what rings after a blow.
pub const DAMPING: f64 = 0.1;

/// Do races with these spin speeds [rad/s], inner and outer, roll balls no faster than where creep laws are viscous, in a bearing whose scene
/// says nothing about steps?
pub fn stands(model: &Model, [inner, outer]: [f64; 2]) -> bool {
    let rolling = 0.5 * (inner - outer).abs() * model.race_length();
    model.solver.unresolved > 0.0 && rolling < REGULARISATION_SPEED
}

/// [rad/s] spin speeds of the races in a state, inner and outer.
pub fn speeds(state: &State) -> [f64; 2] {
    Race::BOTH.map(|race| state.race(race).rate.x)
}
