//! Shafts and housings at rest with their bearings, which are in quasi-static equilibrium themselves.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use super::super::start::held_load;
use super::super::{Simulation, SimulationError};
use super::SystemError;
use super::elements::rollers_out_of_balance;
use crate::dynamics::carried::SeatMotion;
use crate::dynamics::system::{Joint, StructureLoad, StructureTrial};
use crate::model::bodies::Race;
use crate::model::link::one_sided::ROUGH;
use crate::model::link::spring_bearing::SpringBearing;
use crate::model::link::tooth_mesh::ToothMesh;
use crate::model::link::{self, Law, Link, LinkForce};
use crate::model::state::stack;
use crate::model::structure::{Carrier, Map, StructureState, Turning};
use crate::numerics::given::take_out;
use crate::scene::Level;
use crate::scene::system::SystemScene;
use crate::scene::system::mesh::trains;

/// [N/m] of a steel bearing's order: what a stiffness is shifted by where a step makes no progress.
const TYPICAL_STIFFNESS: f64 = 1e7;
/// [-] imbalance over the forces at work that is aimed at, and that is accepted where rounding in the bearings' equilibria stands against
/// less.
const TOLERANCE: f64 = 1e-10;
const ROUNDED: f64 = 1e-6;
/// [-] imbalance over the forces at work below which a step must lower it. Above, it is enough that forces do work in the step: those of bearings are
/// right to some 1e-10, so that the sign of that work holds. Parts that hang in their play come there on steps that raise the imbalance.
const NEAR: f64 = 1e-7;
/// [-] longest step over the smallest ball diameter.
const LONGEST_STEP: f64 = 0.01;
/// [-] part of a preload below which it is gone.
const VANISHED: f64 = 0.01;
/// \[rad] tilt of a seat that no housing is meant to have: ball bearings take less than a half of it.
const FAR: f64 = 0.01;
/// \[N] normal force below which teeth are not pressed together.
const NO_FORCE: f64 = 1e-9;
/// [-] moment on both races together over the sizes of those on each, beyond which balls speed up or slow down: 0 where they roll steadily, as one
/// is the opposite of the other, and 1 where both drive or brake them. Halfway.
const UNSTEADY: f64 = 0.5;
/// Most steps.
const MAX_ITERATIONS: u32 = 400;

/// The structures at rest with their bearings. Vectors have the coordinates of all structures, one after the other.
pub struct Statics<'a> {
    /// The scene.
    pub scene: &'a SystemScene,
    /// \[s] time of the start.
    pub time: f64,
    /// The structures.
    pub carriers: &'a [Carrier],
    /// Scales of the equations of each structure.
    pub scales: &'a [DVector<f64>],
    /// Loads on each from outside.
    pub loads: &'a [StructureLoad],
    /// Races on their seats.
    pub joints: &'a [Joint],
    /// Links.
    pub links: &'a [Link],
    /// Flank on which the teeth of a link are kept in contact, where they are.
    pub flanks: Vec<Option<usize>>,
    /// The bearings.
    pub bearings: &'a mut [Simulation],
    /// [N m] moment of each bearing on its outer race about its axis.
    pub friction: &'a mut [f64],
}

/// Puts a race of a bearing on its seat.
fn place(bearing: &mut Simulation, race: Race, seat: &SeatMotion) {
    bearing.inputs[race].follow(seat.pose(), seat.twist(), seat.rates.x);
}

/// A trial of the statics.
struct Trial {
    residual: DVector<f64>,
    stiffness: DMatrix<f64>,
    /// Stiffness of each bearing.
    of_bearings: Vec<Matrix6<f64>>,
    /// \[N] largest force at work.
    force: f64,
}

impl Statics<'_> {
    /// Sets the coordinates to those in balance: with teeth that are kept in contact first, where a torque presses them together.
    pub fn solve(&mut self, states: &mut [StructureState]) -> Result<(), SystemError> {
        if self.flanks.iter().any(Option::is_some) {
            self.search(states)?;
            let free = vec![None; self.flanks.len()];
            let kept = std::mem::replace(&mut self.flanks, free);
            let found = self.search(states);
            self.flanks = kept;
            return found;
        }
        self.search(states)
    }

    /// Turns shafts so far that the torques on them press teeth together, as if nothing else moved.
    pub fn turn_into_mesh(&mut self, states: &mut [StructureState]) {
        let turns = self.free_turns();
        if turns.is_empty() {
            return;
        }
        // What a component of a displacement is by these turns.
        let by_turns = |link: &Link, component: &Vector6<f64>| {
            let mut by = DVector::zeros(turns.len());
            for (index, end) in link.ends.iter().enumerate() {
                if let Some(k) = turns.iter().position(|turn| *turn == end.structure)
                    && end.coordinates.last() == Some(&(states[end.structure].coordinates.len() - 1))
                {
                    by[k] += component.dot(&end.map.column(end.coordinates.len() - 1)) * link::sign(index);
                }
            }
            by
        };
        // Overlap of the first flank; that of the other is the opposite.
        let overlap = |mesh: &ToothMesh| -stack(&mesh.normals[0], &Vector3::zeros());
        let meshes = self.links.iter().enumerate().filter_map(|(index, link)| match &link.law {
            Law::Mesh(mesh) => Some((index, mesh, by_turns(link, &overlap(mesh)))),
            Law::Spring(_) | Law::Rollers(_) => None,
        });
        let meshes: Vec<_> = meshes.collect();
        let couplings = self.links.iter().filter_map(|link| match &link.law {
            Law::Spring(SpringBearing { torsion: Some((torsion, _)), .. }) => {
                Some((torsion.mean(), by_turns(link, &Vector6::ith(3, 1.0))))
            }
            _ => None,
        });
        let mut torque = DVector::from_fn(turns.len(), |k, _| {
            let force = &self.loads[turns[k]].force;
            force[force.len() - 1]
        });
        let stiffness = meshes.iter().fold(DMatrix::zeros(turns.len(), turns.len()), |sum, (_, mesh, by)| {
            sum + by * by.transpose() * mesh.stiffness
        });
        let stiffness = couplings.fold(stiffness, |sum, (torsion, by)| sum + &by * by.transpose() * torsion);
        let lu = stiffness.lu();
        let Some(first) = lu.solve(&torque) else { return };
        for (index, mesh, by) in &meshes {
            let overlap = by.dot(&first);
            if (overlap * mesh.stiffness).abs() > NO_FORCE {
                self.flanks[*index] = Some(usize::from(overlap < 0.0));
                torque += by * (mesh.stiffness * overlap.signum() * 0.5 * (mesh.backlash + ROUGH));
            }
        }
        let Some(all) = lu.solve(&torque) else { return };
        for (turn, angle) in turns.iter().zip(all.iter()) {
            let last = states[*turn].coordinates.len() - 1;
            states[*turn].coordinates[last] += angle;
        }
    }

    /// Shafts whose turn is a matter of statics: those that a mesh holds against one of their train.
    fn free_turns(&self) -> Vec<usize> {
        let SystemScene { shafts, meshes, springs, .. } = self.scene;
        let trains = trains(shafts, meshes, springs).into_iter().enumerate();
        let free = trains.filter(|(shaft, train)| {
            train.root != *shaft && self.carriers[*shaft].structure.turning == Turning::Free
        });
        free.map(|(shaft, _)| shaft).collect()
    }

    /// Sets the coordinates to those in balance. What is shifted where a step makes no progress is the stiffness; a step is progress
    /// where the unbalanced forces do work in it, as the potential then falls.
    fn search(&mut self, states: &mut [StructureState]) -> Result<(), SystemError> {
        let scales = joined(self.scales.iter());
        let longest = LONGEST_STEP * self.scene.smallest_element();
        let mut at = joined(states.iter().map(|state| &state.coordinates));
        let mut here = self.evaluate(states)?;
        let mut shift = 0.0;
        let mut refused = None;
        let size = |trial: &Trial| trial.residual.component_div(&scales).amax();
        for iterations in 0..MAX_ITERATIONS {
            let allowed = if shift > 1e12 { ROUNDED } else { TOLERANCE };
            if size(&here) <= allowed * here.force.max(1.0) {
                return Ok(());
            }
            if shift > 1e12 {
                let residual = size(&here);
                // What a bearing says is the reason, where it is one.
                let failure = refused.unwrap_or(SystemError::NoEquilibrium { iterations, residual });
                return Err(self.given_way(states).unwrap_or(failure));
            }
            let mut matrix = here.stiffness.clone();
            for (i, scale) in scales.iter().enumerate() {
                matrix[(i, i)] += shift * TYPICAL_STIFFNESS * scale * scale;
            }
            // The turn of a shaft and motions that are given are not a matter of statics.
            take_out(&mut matrix, self.given(), 1.0);
            let step = matrix.lu().solve(&here.residual).map(|mut step| {
                let way = step.component_mul(&scales).amax();
                if way > longest {
                    step *= longest / way;
                }
                step
            });
            let trial = step.filter(|step| step.iter().all(|v| v.is_finite())).and_then(|step| {
                let moved = &at + &step;
                self.set(states, &moved);
                // Only a refusal of the last steps says why the search ends.
                let trial = match self.evaluate(states) {
                    Ok(trial) => trial,
                    Err(why) => {
                        refused = Some(why);
                        return None;
                    }
                };
                refused = None;
                let work = 0.5 * (&here.residual + &trial.residual).dot(&step);
                let downhill = work > 0.0 && size(&here) > NEAR * here.force;
                (downhill || size(&trial) < size(&here) * (1.0 - 1e-6)).then_some((moved, trial))
            });
            match trial {
                Some((moved, trial)) => {
                    (at, here) = (moved, trial);
                    shift = if shift < 1e-9 { 0.0 } else { shift * 0.1 };
                }
                None => {
                    self.set(states, &at);
                    shift = if shift == 0.0 { 1e-9 } else { shift * 5.0 };
                }
            }
        }
        let failure = SystemError::NoEquilibrium { iterations: MAX_ITERATIONS, residual: size(&here) };
        Err(self.given_way(states).unwrap_or(failure))
    }

    /// Is it a housing that lets a bearing tilt further than any takes? What the bearing says of its grooves is not the cause then.
    fn given_way(&self, states: &[StructureState]) -> Option<SystemError> {
        let tilted = |joint: &Joint| {
            let trial = StructureTrial::new(&states[joint.structure]);
            let seat = trial.seat(&self.carriers[joint.structure].structure, &joint.seat);
            let turned = seat.angles - joint.seat.own_tilt();
            (joint.structure, joint.bearing, turned.y.hypot(turned.z))
        };
        // The first structures are the shafts, and the ground does not give way.
        let first = self.scene.shafts.len();
        let housings = first..first + self.scene.housings.len();
        let seats = self.joints.iter().filter(|joint| housings.contains(&joint.structure)).map(tilted);
        let (structure, bearing, tilt) = seats.max_by(|a, b| a.2.total_cmp(&b.2))?;
        (tilt > FAR).then(|| SystemError::GivesWay {
            housing: self.scene.housings[structure - first].name.clone(),
            bearing: self.scene.bearings[bearing].name.clone(),
            tilt,
        })
    }

    /// First coordinate of each structure, and their number.
    pub fn first(&self) -> Vec<usize> {
        self.carriers.iter().fold(vec![0], |mut first, one| {
            first.push(first[first.len() - 1] + one.structure.size());
            first
        })
    }

    /// Sets the coordinates of all structures.
    fn set(&self, states: &mut [StructureState], all: &DVector<f64>) {
        for (state, from) in states.iter_mut().zip(self.first()) {
            let size = state.coordinates.len();
            state.coordinates.copy_from(&all.rows(from, size));
        }
    }

    /// The coordinates that are turns of shafts which nothing holds, or whose motion is given.
    fn given(&self) -> Vec<usize> {
        let held = self.free_turns();
        let ends = self.carriers.iter().zip(self.first().into_iter().skip(1)).enumerate();
        let free =
            ends.filter(|(index, (one, _))| one.structure.turning == Turning::Free && !held.contains(index));
        let turns = free.map(|(_, (_, end))| end - 1);
        let held = self.carriers.iter().zip(self.first());
        let held = held.flat_map(|(one, from)| one.structure.held.iter().map(move |k| from + k));
        turns.chain(held).collect()
    }

    /// Puts the races of all bearings where the structures are.
    fn place_races(&mut self, states: &[StructureState]) {
        for Joint { bearing, race, structure, seat } in self.joints {
            let trial = StructureTrial::new(&states[*structure]);
            place(
                &mut self.bearings[*bearing],
                *race,
                &trial.seat(&self.carriers[*structure].structure, seat),
            );
        }
    }

    fn evaluate(&mut self, states: &[StructureState]) -> Result<Trial, SystemError> {
        self.place_races(states);
        let first = self.first();
        let size = first[first.len() - 1];
        let mut residual = DVector::zeros(size);
        let mut stiffness = DMatrix::zeros(size, size);
        let mut of_bearings = vec![];
        let mut force = 0.0f64;
        let loads = self.carriers.iter().zip(self.loads).zip(self.scales);
        for (((Carrier { structure, .. }, load), scales), (from, state)) in
            loads.zip(first.iter().zip(states))
        {
            let mut outside = load.force.clone();
            if let Some(frame) = &load.frame {
                outside +=
                    structure.frame_force(frame, [&state.coordinates, &state.rates], &state.spin).force;
            }
            let own = &outside - &structure.stiffness * &state.coordinates;
            residual.rows_mut(*from, own.len()).copy_from(&own);
            let own = structure.size();
            stiffness.view_mut((*from, *from), (own, own)).copy_from(&structure.stiffness);
            force = force.max(outside.component_div(scales).amax());
        }
        for index in 0..self.bearings.len() {
            let bearing = &mut self.bearings[index];
            let (load, matrix) = held_load(&bearing.scene, &bearing.model, &mut bearing.inputs, self.time)
                .map_err(|source| self.of_bearing(index, source))?;
            let [x, y, z, about_y, about_z] = load;
            let held = Vector6::new(x, y, z, 0.0, about_y, about_z);
            let inputs = &self.bearings[index].inputs;
            let arm = inputs.inner.pose.position - inputs.outer.pose.position;
            // The races carry the balls together. What these press with across the axis is in the load on the inner race; what acts along their orbit
            // friction carries, on both races alike, which moves parts by less than they give way: all of it is the outer one's here.
            let balls =
                self.bearings[index].model.bearing.ball.mass * self.bearings[index].state.balls.len() as f64;
            let ambient = self.bearings[index].model.ambient(&inputs.effects.frame.motion);
            let none = Vector3::zeros();
            let field = ambient.frame.map_or(none, |frame| frame.field(&none, &none));
            let weight = (ambient.gravity + field) * balls;
            force = force.max(held.fixed_rows::<3>(0).amax());
            let row = |i: usize| if i < 3 { i } else { i + 1 };
            let mut whole = Matrix6::zeros();
            for i in 0..5 {
                for k in 0..5 {
                    whole[(row(i), row(k))] = matrix[(i, k)];
                }
            }
            for Joint { race, structure, seat, .. } in
                self.joints.iter().filter(|joint| joint.bearing == index)
            {
                let turning = Vector3::x() * self.friction[index];
                let on_race = match race {
                    // With states, a start has not yet got what lasts; without, it brakes shafts from the first step on.
                    Race::Inner if self.is_without_states(index) => {
                        stack(&Vector3::zeros(), &-turning) - held
                    }
                    Race::Inner => -held,
                    Race::Outer => {
                        let moment = held.fixed_rows::<3>(3) + arm.cross(&held.fixed_rows::<3>(0));
                        stack(&(held.fixed_rows::<3>(0) + weight), &(moment + turning))
                    }
                };
                let own = self.carriers[*structure].structure.size();
                seat.add_force(&on_race, &mut residual.rows_mut(first[*structure], own));
            }
            let relative = self.relative(index, &first);
            stiffness += relative.tr_mul(&(whole * &relative));
            of_bearings.push(whole);
        }
        for (index, (link, flank)) in self.links.iter().zip(&self.flanks).enumerate() {
            let [displacement, rate] = link.motion(|structure| &states[structure]);
            // Dampers of teeth that turn in step do nothing; their friction knows which way they turn.
            let mut turning = Vector6::zeros();
            turning[3] = rate[3];
            let found = link.mean_force(&displacement, &turning, *flank);
            if !found.is_balanced() {
                return Err(SystemError::Together(rollers_out_of_balance(self.scene, index, self.time)));
            }
            let LinkForce { force: on, by_displacement, friction, .. } = found;
            force = force.max(on.fixed_rows::<3>(0).amax());
            let relative = of_link(link, &first);
            residual += relative.tr_mul(&on);
            // A housing feels the friction of rollers too; a shaft is turned against it.
            let housings = self.scene.shafts.len()..;
            if let Some(end) =
                link.ends.get(1).filter(|end| friction != 0.0 && housings.contains(&end.structure))
            {
                for (k, column) in end.coordinates.iter().zip(end.map.column_iter()) {
                    residual[first[end.structure] + k] -= column[3] * friction;
                }
            }
            stiffness -= relative.tr_mul(&(by_displacement * &relative));
        }
        for given in self.given() {
            residual[given] = 0.0;
        }
        Ok(Trial { residual, stiffness, of_bearings, force })
    }

    /// Motion of a bearing's inner race against its outer one, in the bearing's frame, by all coordinates; with the first one of each
    /// structure, and the end.
    pub fn relative(&self, bearing: usize, first: &[usize]) -> Map {
        let size = first[first.len() - 1];
        let joints = self.joints.iter().filter(|joint| joint.bearing == bearing);
        joints.fold(Map::zeros(size), |relative, Joint { race, structure, seat, .. }| {
            let sign = if *race == Race::Inner { 1.0 } else { -1.0 };
            relative + seat.spread(size, first[*structure]) * sign
        })
    }

    /// Stiffness of all together about where the structures are, and that of each bearing by motion of its inner race against the outer one.
    pub fn stiffness(
        &mut self,
        states: &[StructureState],
    ) -> Result<(DMatrix<f64>, Vec<Matrix6<f64>>), SystemError> {
        self.evaluate(states).map(|trial| (trial.stiffness, trial.of_bearings))
    }

    /// Matrix of all coordinates from one of each bearing, of forces on its inner race by motion of that against the outer one.
    pub fn spread(&self, of_bearings: &[Matrix6<f64>]) -> DMatrix<f64> {
        let first = self.first();
        let size = first[first.len() - 1];
        let mut whole = DMatrix::zeros(size, size);
        for (index, own) in of_bearings.iter().enumerate() {
            let relative = self.relative(index, &first);
            whole += relative.tr_mul(&(own * &relative));
        }
        whole
    }

    /// Refuses preloads \[N] that nothing holds: of which nothing is left, on a shaft that no load takes it from either.
    pub fn check_preloads(&mut self, asked: &[f64], states: &[StructureState]) -> Result<(), SystemError> {
        if self.vanished(asked, states)?.is_none() {
            return Ok(());
        }
        let unloaded: Vec<StructureLoad> = self.loads.iter().map(StructureLoad::without_force).collect();
        let mut unloaded = Statics {
            loads: &unloaded,
            bearings: &mut *self.bearings,
            friction: &mut vec![0.0; asked.len()],
            flanks: vec![None; self.links.len()],
            ..*self
        };
        let mut rest = states.to_vec();
        // One that is not held axially at all goes away under any preload.
        let solved = unloaded.solve(&mut rest);
        let left = solved.and_then(|()| unloaded.vanished(asked, &rest));
        match left {
            Ok(Some((index, left))) => Err(SystemError::Preload {
                name: self.scene.bearings[index].name.clone(),
                asked: asked[index],
                left,
            }),
            _ => Ok(()),
        }
    }

    /// A bearing that asks for a preload \[N] of which next to nothing is left, and what is \[N].
    fn vanished(
        &mut self,
        asked: &[f64],
        states: &[StructureState],
    ) -> Result<Option<(usize, f64)>, SystemError> {
        self.place_races(states);
        for (index, asked) in asked.iter().enumerate().filter(|(_, asked)| **asked > 0.0) {
            let bearing = &mut self.bearings[index];
            let held = held_load(&bearing.scene, &bearing.model, &mut bearing.inputs, self.time);
            let left = held.map_err(|source| self.of_bearing(index, source))?.0[0].abs();
            if left < VANISHED * asked {
                return Ok(Some((index, left)));
            }
        }
        Ok(None)
    }

    /// Starts some of the bearings with their races where the structures are.
    pub fn initialise(&mut self, states: &[StructureState], some: &[usize]) -> Result<(), SystemError> {
        self.place_races(states);
        for &index in some {
            self.bearings[index].initialise().map_err(|source| self.of_bearing(index, source))?;
        }
        Ok(())
    }

    /// Takes the friction torques of bearings that were started. Balls for which no balance was found, as the least loaded ones may have none, are sped up or
    /// braked by both races: what these feel in the first moment is no torque of the bearing.
    pub fn see_friction(&mut self, started: &[usize]) {
        for &index in started {
            let outputs = self.bearings[index].outputs();
            if self.is_without_states(index) {
                self.friction[index] = outputs.relative_speed().signum() * outputs.torque_of_losses();
                continue;
            }
            let [inner, outer] = [&outputs.inner, &outputs.outer];
            let arm = inner.pose.position - outer.pose.position;
            let [on_inner, on_outer] =
                [(inner.wrench.moment + arm.cross(&inner.wrench.force)).x, outer.wrench.moment.x];
            let steady = (on_inner + on_outer).abs() <= UNSTEADY * (on_inner.abs() + on_outer.abs());
            self.friction[index] = if steady { on_outer } else { 0.0 };
        }
    }

    /// Is a bearing without states?
    pub fn is_without_states(&self, index: usize) -> bool {
        self.scene.bearings[index].level() == Level::Equilibrium
    }

    fn of_bearing(&self, index: usize, source: SimulationError) -> SystemError {
        SystemError::Bearing { name: self.scene.bearings[index].name.clone(), source }
    }
}

/// Displacement of the first end of a link against the second by all coordinates; with the first one of each structure, and the end.
pub fn of_link(link: &Link, first: &[usize]) -> Map {
    let mut map = Map::zeros(first[first.len() - 1]);
    for (index, end) in link.ends.iter().enumerate() {
        for (k, column) in end.coordinates.iter().zip(end.map.column_iter()) {
            let mut whole = map.column_mut(first[end.structure] + k);
            whole += column * link::sign(index);
        }
    }
    map
}

/// Vectors of the structures as one.
fn joined<'a>(parts: impl Iterator<Item = &'a DVector<f64>>) -> DVector<f64> {
    let all: Vec<f64> = parts.flat_map(|part| part.iter().copied()).collect();
    DVector::from_vec(all)
}
