//! Records that a run keeps of its steps: heat by contact and powers of loads, for reports, and temperatures, which later steps follow.

use crate::effects::heat::ByContact;
use crate::effects::heat_balance::Heating;
use crate::effects::rating::Turning;
use crate::effects::reports::{Averaged, OfRace};
use crate::forces::{BallPair, Pairs};
use crate::model::bodies::{Body, Race};
use crate::model::energies::Powers;
use crate::model::state::State;
use crate::model::{Conditions, Model};

/// Takes over the pairs at the end of a step of `h` \[s], or of a state that no step has led to.
pub fn record(model: &Model, state: &mut State, pairs: &impl Pairs, conditions: &Conditions, h: Option<f64>) {
    let (balls, spins) = (state.balls.len(), Race::BOTH.map(|race| state.race(race).rate.x));
    if let (Some(rating), Some(sums)) = (&model.rating, &mut state.rating) {
        let loads = (0..balls).map(|ball| loads_of(pairs, ball));
        let turning = Turning { force: radial_force(pairs, balls), spins, load_speed: 0.0 };
        let now = rating.at(loads, turning);
        match h {
            Some(h) => sums.add(now, h),
            None => sums.begin(now),
        }
    }
    if let (Some(balance), Some(warm), Some(h)) = (&model.heat_balance, &mut state.warm, h) {
        let mut roots = [0.0; 2];
        for loads in (0..balls).map(|ball| loads_of(pairs, ball)) {
            for (sum, load) in roots.iter_mut().zip(loads) {
                *sum += load.sqrt();
            }
        }
        let heating = Heating {
            powers: &powers(pairs, balls),
            guide: model.cage_guide().map(|race| race as usize),
            loads: roots,
            speed: spins[0] - spins[1],
            lubrication: if model.films.is_some() { conditions.lubrication } else { 1.0 },
        };
        balance.advance(warm, &heating, h);
    }
    if let Some(heat) = &mut state.heat {
        let supports = state.supports.iter().flatten().fold(0.0, |sum, support| sum + support.lost);
        let medium = if model.has_medium() { state.powers.around - supports } else { 0.0 };
        let powers = ByContact { medium, ..powers(pairs, balls) };
        match h {
            Some(h) => heat.add(powers, h),
            None => heat.begin(powers, state.time),
        }
    }
    if state.means.is_some() {
        let now = averaged(model, state);
        let time = state.time;
        if let Some(means) = &mut state.means {
            match h {
                Some(h) => means.add(now, h),
                None => means.begin(now, time),
            }
        }
    }
}

/// Quantities that have means, of a state whose forces and powers are those of this moment.
fn averaged(model: &Model, state: &State) -> Averaged {
    let of_race = |race: Race| {
        let wrench = state.wrench_on(race);
        let drive_torque = state.drive_torque(model.bodies[race].as_ref(), race);
        OfRace { force: wrench.force.into(), moment: wrench.moment.into(), drive_torque }
    };
    let Powers { friction, damping, around, .. } = state.powers;
    Averaged {
        races: Race::BOTH.map(of_race),
        friction,
        lost: friction + damping + around,
        cage_speed: state.cage_speed(),
    }
}

/// \[N] y and z component of the force of the inner race on all balls.
fn radial_force(pairs: &impl Pairs, balls: usize) -> [f64; 2] {
    let mut force = [0.0; 2];
    for ball in 0..balls {
        pairs.of_ball(ball, |body, pair| {
            if body == Body::Race(Race::Inner) {
                force = [force[0] + pair.force.y, force[1] + pair.force.z];
            }
        });
    }
    force
}

/// \[N] loads of a ball on the inner and the outer race.
fn loads_of(pairs: &impl Pairs, ball: usize) -> [f64; 2] {
    let mut loads = [0.0; 2];
    pairs.of_ball(ball, |body, pair| {
        if let Body::Race(race) = body {
            loads[race as usize] = pair.load;
        }
    });
    loads
}

/// \[W] powers lost to friction, by what touches.
fn powers(pairs: &impl Pairs, balls: usize) -> ByContact {
    let mut powers = ByContact::default();
    for ball in 0..balls {
        pairs.of_ball(ball, |body, pair| match body {
            Body::Race(race) => powers.races[race as usize] += pair.friction_power,
            Body::Cage => powers.pockets += pair.friction_power,
        });
    }
    for BallPair { forces, .. } in pairs.between_balls() {
        powers.balls += forces.friction_power;
    }
    for (_, _, pair) in pairs.between_bodies() {
        powers.lands += pair.friction_power;
    }
    powers
}
