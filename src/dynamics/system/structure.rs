//! A structure in one trial step: motion from its unknown accelerations, seats of its races, residual and tangent.

use nalgebra::{DMatrix, DVector, DVectorViewMut, Dyn, OMatrix, U6, Vector3, Vector6};

use super::super::carried::SeatMotion;
use crate::effects::moving_frame::MovingFrame;
use crate::model::link::LinkEnd;
use crate::model::state::stack;
use crate::model::structure::{
    FrameForce, Map, OwnForces, Spin, Structure, StructureEnergies, StructurePowers, StructureState, Turning,
};
use crate::numerics::hermite::Hermite;
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::Wrench;

/// Loads on a structure from outside at the end of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureLoad {
    /// Generalised force of loads and weight, the torque that drives it included where the turn is a coordinate.
    pub force: DVector<f64>,
    /// Its turn, where that is given.
    pub spin: Spin,
    /// [N m] axial moment of the loads, where the turn is given: the drive holds it.
    pub axial_moment: f64,
    /// The frame that turns, about the origin of the machine's axes; what its origin's acceleration does is in the force.
    pub frame: Option<MovingFrame>,
    /// Value, rate and its rate of each coordinate whose motion is given.
    pub held: Vec<[f64; 3]>,
}

impl StructureLoad {
    /// Load without forces from outside.
    #[must_use]
    pub fn without_force(&self) -> Self {
        Self { force: DVector::zeros(self.force.len()), axial_moment: 0.0, frame: None, ..self.clone() }
    }
}

/// Where a structure carries a race.
#[derive(Clone, Debug)]
pub struct Seat {
    /// Coordinates of the structure that move it: a few of many where the structure is flexible.
    coordinates: Vec<usize>,
    /// Place (0 to 2) and angles (3 to 5) of the race in its bearing's frame, by these coordinates.
    map: Map,
    /// \[m] place of the race's origin in that frame while the coordinates are zero.
    offset: Vector3<f64>,
    /// \[rad] its tilt there.
    tilt: Vector3<f64>,
    /// 1, or -1 where the bearing's x axis points against the shaft's.
    direction: f64,
}

impl Seat {
    /// At a station, in a bearing whose x axis points along the shaft (1) or against it (-1, by half a turn about z); with the place of
    /// the race's origin along x \[m] while the coordinates are zero.
    pub fn new(station: &Map, direction: f64, offset: f64) -> Self {
        let coordinates: Vec<usize> =
            (0..station.ncols()).filter(|k| station.column(*k).amax() > 0.0).collect();
        let signs = [direction, direction, 1.0];
        let map = Map::from_fn(coordinates.len(), |row, k| station[(row, coordinates[k])] * signs[row % 3]);
        Self { coordinates, map, offset: Vector3::new(offset, 0.0, 0.0), tilt: Vector3::zeros(), direction }
    }

    /// Seat at another place across the axis \[m] and with a tilt [0, ry, rz] \[rad] of its own, in the axes of the structure.
    #[must_use]
    pub fn lying_off(mut self, place: Vector3<f64>, tilt: Vector3<f64>) -> Self {
        let signs = Vector3::new(self.direction, self.direction, 1.0);
        self.offset += signs.component_mul(&place);
        self.tilt = signs.component_mul(&tilt);
        self
    }

    /// \[rad] its tilt while the coordinates are zero, in the bearing's frame.
    pub fn own_tilt(&self) -> &Vector3<f64> {
        &self.tilt
    }

    /// Place and angles of the race in its bearing's frame by these coordinates.
    pub fn map(&self) -> &Map {
        &self.map
    }

    /// Coordinates of the structure that move it.
    pub fn coordinates(&self) -> &[usize] {
        &self.coordinates
    }

    /// Adds the generalised force of a force and moments about the axes of the angles, in the bearing's frame.
    pub fn add_force(&self, force: &Vector6<f64>, into: &mut DVectorViewMut<'_, f64>) {
        let own = self.map.tr_mul(force);
        self.coordinates.iter().zip(own.iter()).for_each(|(k, value)| into[*k] += value);
    }

    /// The map by all of `size` coordinates from `first` on.
    pub fn spread(&self, size: usize, first: usize) -> Map {
        let mut map = Map::zeros(size);
        for (column, k) in self.map.column_iter().zip(&self.coordinates) {
            map.set_column(first + k, &column);
        }
        map
    }

    /// Motion of the race at these coordinates, rates and accelerations.
    pub fn motion(&self, [q, rates, accelerations]: [&DVector<f64>; 3], given: Option<&Spin>) -> SeatMotion {
        let halves = |v: &DVector<f64>| {
            let moved = self.coordinates.iter().zip(self.map.column_iter());
            let moved = moved.fold(Vector6::zeros(), |sum, (k, column)| sum + column * v[*k]);
            (moved.fixed_rows::<3>(0).into_owned(), moved.fixed_rows::<3>(3).into_owned())
        };
        let ((place, mut angles), (velocity, mut spins)) = (halves(q), halves(rates));
        // Zeros keep their signs.
        if self.tilt != Vector3::zeros() {
            angles += self.tilt;
        }
        if let Some(spin) = given {
            angles.x += self.direction * spin.angle;
            spins.x += self.direction * spin.speed;
        }
        SeatMotion {
            position: self.offset + place,
            velocity,
            acceleration: halves(accelerations).0,
            angles,
            rates: spins,
        }
    }
}

/// A structure in a trial step.
#[derive(Clone, Debug)]
pub struct StructureTrial {
    /// State at the end of the step.
    pub end: StructureState,
    /// Remainder of the equations of motion.
    pub residual: DVector<f64>,
    /// Generalised force of its bearings and links.
    from_bearings: DVector<f64>,
    /// [N m] moment of them about its axis.
    axial: f64,
    /// Forces of the structure itself where it is.
    own: OwnForces,
    /// `M q''` there.
    inertia: DVector<f64>,
    /// Inertial forces of a frame that turns.
    from_frame: Option<FrameForce>,
}

impl StructureTrial {
    /// Buffers, as at the start of a step.
    pub fn new(start: &StructureState) -> Self {
        let zero = DVector::zeros(start.coordinates.len());
        Self {
            end: start.clone(),
            residual: zero.clone(),
            from_bearings: zero,
            axial: 0.0,
            own: OwnForces::default(),
            inertia: DVector::default(),
            from_frame: None,
        }
    }

    /// Moves the structure to the end of the step.
    pub fn move_to(
        &mut self,
        model: &Structure,
        unknowns: &[f64],
        start: &StructureState,
        step: &HhtStep,
        load: &StructureLoad,
    ) {
        let end = &mut self.end;
        end.accelerations.copy_from_slice(unknowns);
        let (before, after) = (&start.accelerations, &end.accelerations);
        end.rates = &start.rates + (before * (1.0 - step.gamma) + after * step.gamma) * step.h;
        end.coordinates = &start.coordinates
            + &start.rates * step.h
            + (before * (0.5 - step.beta) + after * step.beta) * (step.h * step.h);
        model.hold(end, &load.held);
        end.spin = model.spin([&end.coordinates, &end.rates, &end.accelerations], load.spin);
        self.act(model, load);
        self.inertia = &model.mass * &self.end.accelerations;
    }

    /// What the structure and its frame do where it is, whatever bearings and links do.
    fn act(&mut self, model: &Structure, load: &StructureLoad) {
        let StructureState { coordinates, rates, spin, .. } = &self.end;
        self.own = model.own_forces(coordinates, rates, spin);
        self.from_frame =
            load.frame.as_ref().map(|frame| model.frame_force(frame, [coordinates, rates], spin));
    }

    /// Motion of a seat at the end of the step.
    pub fn seat(&self, model: &Structure, seat: &Seat) -> SeatMotion {
        let StructureState { coordinates, rates, accelerations, spin, .. } = &self.end;
        let given = (model.turning == Turning::Given).then_some(spin);
        seat.motion([coordinates, rates, accelerations], given)
    }

    /// Forgets the forces of bearings and links.
    pub fn clear(&mut self) {
        self.from_bearings.fill(0.0);
        self.axial = 0.0;
    }

    /// Adds the wrench of a bearing on the race that it carries on a seat, in the bearing's frame.
    pub fn add(&mut self, seat: &Seat, motion: &SeatMotion, wrench: &Wrench) {
        let (moments, _) = motion.generalised(&wrench.moment);
        seat.add_force(&stack(&wrench.force, &moments), &mut self.from_bearings.as_view_mut());
        self.axial += seat.direction * moments.x;
    }

    /// Adds force and moment on an end of a link.
    pub fn add_link(&mut self, end: &LinkEnd, force: &Vector6<f64>) {
        let own = end.map.tr_mul(force);
        end.coordinates.iter().zip(own.iter()).for_each(|(k, value)| self.from_bearings[*k] += value);
        self.axial += end.turn.dot(force);
    }

    /// Residual under what acts from outside and the bearings.
    pub fn assemble(
        &mut self,
        model: &Structure,
        start: &StructureState,
        load: &StructureLoad,
        step: &HhtStep,
    ) {
        let fraction = 1.0 - step.alpha_f;
        self.sum_forces(model, load);
        let end = &mut self.end;
        self.residual =
            &self.inertia - &end.total * fraction - &start.total * step.alpha_f + &start.remainder;
        model.held.iter().for_each(|k| self.residual[*k] = 0.0);
        end.remainder.copy_from(&self.residual);
        self.account(model, load);
    }

    /// The state where a run starts: accelerations, torque and powers under what acts from outside and the bearings.
    pub fn started(mut self, model: &Structure, load: &StructureLoad) -> StructureState {
        self.act(model, load);
        self.sum_forces(model, load);
        let end = &mut self.end;
        // The ground has no coordinates where no ring slides.
        let solved = (model.size() > 0).then(|| (*model.mass).clone().lu().solve(&end.total));
        end.accelerations = solved.flatten().unwrap_or_else(|| DVector::zeros(model.size()));
        model.hold(end, &load.held);
        end.spin = model.spin([&end.coordinates, &end.rates, &end.accelerations], end.spin);
        self.account(model, load);
        let mut end = self.end;
        let stored = model.stored(&self.own, &end.coordinates, &end.rates, &end.spin);
        end.energies = StructureEnergies { stored, at_start: stored, ..StructureEnergies::default() };
        end
    }

    /// The state at a time \[s] within the step from one state to another, before the forces of its bearings; its energies are those at the start.
    pub fn within(
        model: &Structure,
        [start, end]: [&StructureState; 2],
        between: Hermite,
        load: &StructureLoad,
    ) -> Self {
        let mut trial = Self::new(start);
        let at = &mut trial.end;
        let of = |state: &StructureState| {
            (state.coordinates.clone(), state.rates.clone(), state.accelerations.clone())
        };
        let ((q0, v0, a0), (q1, v1, a1)) = (of(start), of(end));
        at.accelerations = between.linear([a0, a1]);
        at.coordinates = between.at([q0, q1], [v0.clone(), v1.clone()]);
        at.rates = between.linear([v0, v1]);
        model.hold(at, &load.held);
        at.spin = model.spin([&at.coordinates, &at.rates, &at.accelerations], load.spin);
        trial.act(model, load);
        trial
    }

    /// State at the end, with the forces of its bearings.
    pub fn settled(mut self, model: &Structure, load: &StructureLoad) -> StructureState {
        self.sum_forces(model, load);
        self.account(model, load);
        self.ended(model)
    }

    /// State at the end with the energy that is stored there.
    pub fn ended(mut self, model: &Structure) -> StructureState {
        let StructureState { coordinates, rates, spin, .. } = &self.end;
        self.end.energies.stored = model.stored(&self.own, coordinates, rates, spin);
        self.end
    }

    /// Total force.
    fn sum_forces(&mut self, model: &Structure, load: &StructureLoad) {
        let end = &mut self.end;
        end.total = &load.force + &self.from_bearings + &self.own.total;
        if let Some(frame) = &self.from_frame {
            end.total += &frame.force;
        }
        if model.turning == Turning::Free {
            let last = model.size() - 1;
            let lag = model.spin_torque(&self.own, &end.accelerations, &Spin::default());
            end.total[last] -= lag;
        }
    }

    /// Forces that hold a given speed and given coordinates, and powers.
    fn account(&mut self, model: &Structure, load: &StructureLoad) {
        let end = &mut self.end;
        for (force, &k) in end.holding.iter_mut().zip(&model.held) {
            *force = model.mass.row(k).transpose().dot(&end.accelerations) - end.total[k];
        }
        let holding = end.holding.iter().zip(&model.held);
        let held: f64 = holding.map(|(force, k)| force * end.rates[*k]).sum();
        let turns = model.turning == Turning::Given;
        let mut outside = load.axial_moment;
        let mut power = load.force.dot(&end.rates) + held;
        if let Some(frame) = &self.from_frame {
            outside += frame.axial;
            power += frame.force.dot(&end.rates);
        }
        end.torque = match turns {
            true => model.spin_torque(&self.own, &end.accelerations, &end.spin) - self.axial - outside,
            false => 0.0,
        };
        let drive = if turns { (end.torque + outside) * end.spin.speed } else { 0.0 };
        let of_spin = if turns { self.axial * end.spin.speed } else { 0.0 };
        end.powers = StructurePowers {
            input: power + drive,
            bearings: -(self.from_bearings.dot(&end.rates) + of_spin),
            damping: self.own.damped(&end.rates),
        };
    }

    /// Adds the tangent of the residual by the accelerations to a matrix, from a row and column on: without that of the bearings, and
    /// without a frame that turns, as its part is the way that the frame turns by in a step.
    pub fn add_tangent(&self, model: &Structure, step: &HhtStep, matrix: &mut DMatrix<f64>, from: usize) {
        let fraction = 1.0 - step.alpha_f;
        let [position, velocity] = step.force_gains();
        let StructureState { coordinates, rates, accelerations, spin, .. } = &self.end;
        model.mass.add_to(1.0, matrix, from);
        model.stiffness.add_to(position, matrix, from);
        model.damping.add_to(velocity, matrix, from);
        model.gyroscopic.add_to(velocity * spin.speed + position * 0.5 * spin.acceleration, matrix, from);
        if model.turning == Turning::Free {
            let last = from + model.size() - 1;
            let half = 0.5 * fraction;
            let by_spin = &model.gyroscopic * &(rates * velocity + coordinates * half);
            let mut column = matrix.column_mut(last);
            let mut column = column.rows_mut(from, by_spin.len());
            column += by_spin;
            // `1/2 q''^T G q`
            let of_q = model.gyroscopic.tr_mul(accelerations) * (0.5 * position);
            let of_accelerations = &model.gyroscopic * coordinates * half;
            let mut row = matrix.row_mut(last);
            let mut row = row.columns_mut(from, of_q.len());
            row += (of_q + of_accelerations).transpose();
        }
    }

    /// Derivative of the residual by the coordinates through the direction of a bearing's moments alone, times a gain; rows and columns are
    /// [`Seat::coordinates`].
    pub fn turned_moments(
        seat: &Seat,
        motion: &SeatMotion,
        moment: &Vector3<f64>,
        gain: f64,
    ) -> DMatrix<f64> {
        let (_, by_angles) = motion.generalised(moment);
        let angles = seat.map.fixed_rows::<3>(3);
        angles.tr_mul(&(by_angles * angles)) * -gain
    }

    /// Unknowns of a carried race (acceleration, and angular acceleration in world axes times `length` \[m]) by those of
    /// [`Seat::coordinates`].
    /// Its transpose takes residual rows of the race (force, moment over `length`) to the structure's.
    pub fn unknowns_of(seat: &Seat, motion: &SeatMotion, length: f64) -> OMatrix<f64, U6, Dyn> {
        let mut unknowns = seat.map.clone();
        let angular = motion.columns() * seat.map.fixed_rows::<3>(3) * length;
        unknowns.fixed_rows_mut::<3>(3).copy_from(&angular);
        unknowns
    }
}
