//! What joins the structures of a step: races on their seats, links, bearings without states; their forces and tangents in the rows of the structures.

use super::step::{Joint, SystemStep};
use super::structure::StructureTrial;
use crate::model::link::{self, LinkForce};
use crate::numerics::given::take_out;
use crate::numerics::size::{larger, largest};

impl SystemStep<'_> {
    /// Sets the races that structures carry to where these are.
    fn carry_races(&mut self) {
        for (carried, step) in self.carried.iter_mut().zip(&mut self.bearings) {
            for race in carried {
                let Joint { structure, seat, .. } = race.joint;
                let motion = self.trials[*structure].seat(self.structures[*structure].model, seat);
                race.follow(&motion, step);
            }
        }
    }

    /// What is joined to structures where these are: races that they carry, forces of links, bearings without states.
    pub(super) fn see_structures(&mut self) {
        self.carry_races();
        self.link_forces.clear();
        for (link, before) in self.joined.links.iter().zip(self.joined.link_states) {
            let [displacement, rate] = link.motion(|structure| &self.trials[structure].end);
            self.link_forces.push(link.force(&displacement, &rate, before));
        }
        self.seen.clear();
        for element in self.joined.elements {
            let seen = element.see(&self.trials, self.structures);
            let on = element.forces(&seen);
            self.seen.push((seen, on));
        }
    }

    /// Residuals of the structures under what their bearings do; the largest over the tolerance.
    pub(super) fn assemble_structures(&mut self) -> f64 {
        self.trials.iter_mut().for_each(StructureTrial::clear);
        let mut tolerance = self.joined.of_links.map_or(f64::INFINITY, |may_leave| may_leave.force);
        for Joint { bearing, race, structure, seat } in self.joined.joints {
            let step = &self.bearings[*bearing];
            tolerance = tolerance.min(step.force_tolerance);
            if let Some(trial) = &step.workspace.bodies[*race]
                && let Some(motion) = trial.seat()
            {
                self.trials[*structure].add(seat, motion, &trial.end.bearing_wrench);
            }
        }
        for (link, LinkForce { force, .. }) in self.joined.links.iter().zip(&self.link_forces) {
            for (index, end) in link.ends.iter().enumerate() {
                self.trials[end.structure].add_link(end, &(force * link::sign(index)));
            }
        }
        for (element, (seen, on)) in self.joined.elements.iter().zip(&self.seen) {
            tolerance = tolerance.min(element.may_leave.force);
            element.add(seen, on, &mut self.trials);
        }
        let mut norm = 0.0;
        for (index, (one, trial)) in self.structures.iter().zip(&mut self.trials).enumerate() {
            trial.assemble(one.model, one.start, one.load, &self.step);
            let forces = trial.residual.component_div(one.scales);
            // All its races leave something in it: without this, each of many would be held to a tighter tolerance than one of a pair.
            let joints = self.joined.joints.iter().filter(|joint| joint.structure == index).count();
            let elements =
                self.joined.elements.iter().flat_map(|element| element.joint.seats.iter().flatten());
            let races = joints + elements.filter(|(structure, _)| *structure == index).count();
            let tolerance = tolerance * f64::max(0.5 * races as f64, 1.0);
            norm = larger(norm, largest(forces.iter()) / tolerance);
        }
        norm
    }

    /// Assembles and factorises the border.
    pub(super) fn factorise(&mut self) {
        let gains = self.step.force_gains();
        let mut matrix = self.border.cleared(self.rows[self.structures.len()]);
        for ((one, trial), at) in self.structures.iter().zip(&self.trials).zip(&self.rows) {
            trial.add_tangent(one.model, &self.step, &mut matrix, *at);
        }
        for Joint { bearing, race, structure, seat } in self.joined.joints {
            if let Some(trial) = &self.bearings[*bearing].workspace.bodies[*race]
                && let Some(motion) = trial.seat()
            {
                let moment = &trial.end.bearing_wrench.moment;
                let turned = StructureTrial::turned_moments(seat, motion, moment, gains[0]);
                let at = self.rows[*structure];
                for (i, row) in seat.coordinates().iter().enumerate() {
                    for (k, column) in seat.coordinates().iter().enumerate() {
                        matrix[(at + row, at + column)] += turned[(i, k)];
                    }
                }
            }
        }
        for (link, LinkForce { by_displacement, by_rate, .. }) in
            self.joined.links.iter().zip(&self.link_forces)
        {
            let by_acceleration = by_displacement * gains[0] + by_rate * gains[1];
            let ends = || link.ends.iter().enumerate();
            for ((i, row), (k, column)) in ends().flat_map(|row| ends().map(move |column| (row, column))) {
                let signs = -link::sign(i) * link::sign(k);
                let block = row.map.tr_mul(&(by_acceleration * &column.map)) * signs;
                for (from, place) in row.coordinates.iter().enumerate() {
                    for (to, other) in column.coordinates.iter().enumerate() {
                        let at = (self.rows[row.structure] + place, self.rows[column.structure] + other);
                        matrix[at] += block[(from, to)];
                    }
                }
            }
        }
        for (element, (seen, on)) in self.joined.elements.iter().zip(&self.seen) {
            element.add_tangent((seen, on), gains, &self.rows, &mut matrix);
        }
        for (step, carried) in self.bearings.iter().zip(&self.carried) {
            for rows in carried {
                carried
                    .iter()
                    .for_each(|columns| rows.add_block(columns, &step.workspace.reduced, &mut matrix));
            }
        }
        take_out(&mut matrix, self.held.iter().copied(), 1.0);
        let rows = self.bearings.iter().map(|step| step.workspace.reduced.as_slice());
        self.border.factorise(matrix, rows, gains);
    }
}
