//! Small motions of a shaft, its housings and its bearings about where they are: which grow, and what moves in them.

use nalgebra::{Complex, DMatrix, DVector};

use super::System;
use super::elements;
use super::statics::of_link;
use super::structures::Structures;
use crate::analysis::small_motions::{Mover, Seated, SmallMotion, SmallMotions};
use crate::dynamics::system::{Joint, StructureTrial};
use crate::model::bodies::{Body, Race};
use crate::model::structure::{Carrier, Map};
use crate::numerics::modes::Mode;
use crate::simulation::motions::{Motion, Part, free, named, seated, swings, worth_telling};

impl System {
    /// Motions of shaft, housings, rings and cages about the present state that swing, by their frequency; in a frame that moves, as they are
    /// seen from it. None where eigenvalues are not found.
    pub fn motions(&self) -> Option<Vec<Motion>> {
        let own: Vec<Vec<_>> =
            self.bearings.iter().map(|bearing| bearing.moving_bodies().collect()).collect();
        let of_carriers: usize =
            self.structures.carriers.iter().map(|carrier| carrier.structure.size()).sum();
        let of_bodies: usize = own.iter().flatten().map(|(_, moved, _)| free(moved).len()).sum();
        let size = of_carriers + of_bodies;
        let mut movers = vec![];
        let mut first = vec![];
        let mut next = 0;
        for (Carrier { structure, .. }, state) in self.structures.carriers.iter().zip(&self.structures.states)
        {
            first.push(next);
            next += structure.size();
            let mut own = Mover {
                mass: (*structure.mass).clone(),
                damping: &*structure.damping + &*structure.gyroscopic * state.spin.speed,
                stiffness: (*structure.stiffness).clone(),
            };
            own.add(self.frame_matrices(structure, state));
            movers.push(own);
        }
        let structures = movers.clone();
        if !self.structures.links.is_empty() || !self.structures.elements.is_empty() {
            let mut whole = self.linked(&structures, &first);
            self.add_elements(&mut whole, &first);
            movers = vec![whole];
        }
        let mut parts = vec![];
        let mut running = vec![];
        let mut across = vec![];
        for (index, (bearing, bodies)) in self.bearings.iter().zip(&own).enumerate() {
            let carried = self.structures.joints.iter().filter(|joint| joint.bearing == index);
            let mut seats: Vec<Seated> = carried.map(|joint| self.seated(joint, size, &first)).collect();
            for (body, moved, state) in bodies {
                movers.push(bearing.mover(moved, state));
                seats.push(seated((*body, moved), state, bearing.applied_moment(*body), (next, size)));
                parts.push((index, (*body, *moved, *state), next));
                next += free(moved).len();
            }
            // Places of one race against the other, by all coordinates.
            let map = |race: Race| {
                let seat = seats.iter().find(|seat| seat.body == race.into());
                seat.map_or_else(|| Map::zeros(size), |seat| seat.map.clone())
            };
            across.push((map(Race::Inner) - map(Race::Outer), bearing));
            if !bearing.model.without_states {
                running.push(bearing.running(seats));
            }
        }
        let motions = SmallMotions::new(&movers, &running).holding(&self.held()).motions(swings)?;
        let structures = structures.iter().zip(&first);
        let structures: Vec<_> = structures.collect();
        let name = |motion: &SmallMotion| {
            let energy = |(mover, from): &(&Mover, &usize)| {
                let own = motion.shape.rows(**from, mover.mass.nrows());
                let part = |own: DVector<f64>| own.dot(&(&mover.mass * &own));
                part(own.map(|value| value.re)) + part(own.map(|value| value.im))
            };
            let of_structures: f64 = structures.iter().map(energy).sum();
            let moving = parts.iter().map(|(index, (body, moved, state), from)| {
                let own = free(moved);
                let shape = motion.shape.rows(*from, own.len()).into_owned();
                let part = Part::new(*body, moved, state.rate.x, (&own, &shape));
                part.of(&self.structures.scene.bearings[*index].name)
            });
            let moving: Vec<Part> = moving.collect();
            let of_parts: f64 = moving.iter().map(Part::energy).sum();
            if of_structures < of_parts {
                return named(&moving);
            }
            let shape = motion.shape.rows(0, of_carriers).into_owned();
            let mode = self.describe(&Mode { eigenvalue: motion.value, shape }, &[]);
            format!("{}, {}", mode.place, mode.whirl.name())
        };
        let moves_most = |motion: &SmallMotion| {
            let moved = |map: &Map| {
                let rows = map.fixed_rows::<3>(0).map(Complex::from) * &motion.shape;
                rows.iter().map(Complex::norm_sqr).sum::<f64>()
            };
            let most = across.iter().max_by(|a, b| moved(&a.0).total_cmp(&moved(&b.0)));
            most.and_then(|(_, bearing)| bearing.rolls_over())
        };
        Some(worth_telling(&motions, name, moves_most))
    }

    /// All structures with what links them.
    fn linked(&self, movers: &[Mover], first: &[usize]) -> Mover {
        let mut ends = first.to_vec();
        ends.push(movers.iter().map(|mover| mover.mass.nrows()).sum());
        let size = ends[ends.len() - 1];
        let zero = || DMatrix::zeros(size, size);
        let mut whole = Mover { mass: zero(), damping: zero(), stiffness: zero() };
        for (own, from) in movers.iter().zip(first) {
            let at = ((*from, *from), (own.mass.nrows(), own.mass.nrows()));
            whole.mass.view_mut(at.0, at.1).copy_from(&own.mass);
            whole.damping.view_mut(at.0, at.1).copy_from(&own.damping);
            whole.stiffness.view_mut(at.0, at.1).copy_from(&own.stiffness);
        }
        for (link, state) in self.structures.links.iter().zip(&self.structures.link_states) {
            let map = of_link(link, &ends);
            let force = link.force(&state.displacement, &state.rate, state);
            whole.stiffness -= map.tr_mul(&(force.by_displacement * &map));
            whole.damping -= map.tr_mul(&(force.by_rate * &map));
        }
        whole
    }

    /// Adds bearings without states: their balls go along at once.
    fn add_elements(&self, whole: &mut Mover, first: &[usize]) {
        let Structures { elements, element_states, carriers, states, .. } = &self.structures;
        for (joint, state) in elements.iter().zip(element_states) {
            let bearing = &self.bearings[joint.bearing];
            let boundary = bearing.boundary(self.time());
            let step = elements::step(joint, state, bearing, &boundary, 0.0);
            let seen = step.seen_in(carriers, states);
            let on = step.forces(&seen);
            step.add_tangent((&seen, &on), [1.0, 0.0], first, &mut whole.stiffness);
            step.add_tangent((&seen, &on), [0.0, 1.0], first, &mut whole.damping);
        }
    }

    /// A race on its seat, by `size` coordinates, of which those of each structure begin at `first`.
    fn seated(&self, joint: &Joint, size: usize, first: &[usize]) -> Seated {
        let Joint { race, structure, seat, .. } = joint;
        let carrier = &self.structures.carriers[*structure].structure;
        Seated {
            body: Body::Race(*race),
            map: seat.spread(size, first[*structure]),
            motion: StructureTrial::new(&self.structures.states[*structure]).seat(carrier, seat),
            applied: nalgebra::Vector3::zeros(),
        }
    }
}
