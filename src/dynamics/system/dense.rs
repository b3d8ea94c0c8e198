//! Dense output of a system: bearings and structures at a time within a step that was accepted.

use super::structure::StructureTrial;
use super::{Joined, Joint, StructureStep, finished};
use crate::dynamics::{Boundary, StepBound, dense};
use crate::model::structure::StructureState;
use crate::model::{Model, link};
use crate::numerics::hermite::Hermite;

/// A bearing over a step.
pub struct Stepped<'a> {
    /// Its model.
    pub model: &'a Model,
    /// States where the step began and ended.
    pub ends: [&'a StepBound; 2],
    /// Boundary at the time that is asked for.
    pub boundary: Boundary,
}

/// Bearings with their contacts, and structures, at `part` \[s] of a step of `h` \[s]; the structures have the loads of that time.
pub fn within(
    bearings: &mut [Stepped<'_>],
    structures: &[StructureStep<'_>],
    ends: &[StructureState],
    joined: Joined<'_>,
    (part, h): (f64, f64),
) -> (Vec<StepBound>, Vec<StructureState>) {
    let between = Hermite::new(part, h);
    let moved = structures
        .iter()
        .zip(ends)
        .map(|(one, end)| StructureTrial::within(one.model, [one.start, end], between, one.load));
    let mut trials: Vec<_> = moved.collect();
    let mut seats = vec![];
    for Joint { bearing, race, structure, seat } in joined.joints {
        let motion = trials[*structure].seat(structures[*structure].model, seat);
        bearings[*bearing].boundary.motion[*race] = (motion.pose(), motion.twist());
        seats.push(motion);
    }
    let of_bearing = |of: &Stepped<'_>| dense::within(of.model, of.ends, &of.boundary);
    let bearings: Vec<_> = bearings.iter().map(of_bearing).collect();
    for (Joint { bearing, race, structure, seat }, motion) in joined.joints.iter().zip(&seats) {
        trials[*structure].add(seat, motion, &bearings[*bearing].state.race(*race).bearing_wrench);
    }
    for (one, before) in joined.links.iter().zip(joined.link_states) {
        let [displacement, rate] = one.motion(|structure| &trials[structure].end);
        let force = one.force(&displacement, &rate, before).force;
        for (index, end) in one.ends.iter().enumerate() {
            trials[end.structure].add_link(end, &(force * link::sign(index)));
        }
    }
    for element in joined.elements {
        let seen = element.see(&trials, structures);
        element.add(&seen, &element.forces(&seen), &mut trials);
    }
    let settled = trials.into_iter().zip(structures).map(|(trial, one)| {
        let state = trial.settled(one.model, one.load);
        finished(one, state, part)
    });
    (bearings, settled.collect())
}
