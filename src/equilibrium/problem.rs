//! A quasi-static problem as equations: unknowns, residual, and the search for its root.

use nalgebra::{SMatrix, SymmetricEigen};

use super::ball::{BallBalance, D, N_SHARED, Place, SHARED};
use super::trial::{SharedMatrix, SharedVector, Trial, evaluate, finish, outside_of_race};
use super::{Equilibrium, EquilibriumError, EquilibriumInput, MAX_APPROACH, Prescribed};
use crate::contact::form::SHORTEST;
use crate::model::bodies::Race;
use crate::model::{Conditions, Model};
use crate::numerics::motion::Pose;
use crate::numerics::scalar::Single;
use crate::numerics::size::{larger, largest};

/// [-] accepted residual over the size of the forces at work.
pub(super) const TOLERANCE: f64 = 1e-11;
/// [-] residual below which steps must lower the residual, even where the search follows the potential.
const NEAR: f64 = 1e-4;
/// [-] thrust over radial load that settles which sides of the grooves carry it: two states at once were seen to 0.005.
const SETTLING_THRUST: f64 = 0.05;
/// Iterations on the displacements; a typical solve takes 5 to 15.
const MAX_ITERATIONS: u32 = 400;
/// [-] stiffness over the largest one of the free directions below which it is rounding.
const NO_STIFFNESS: f64 = 1e-10;
/// [-] first way off an unstable balance over the ball diameter, and how often it is doubled: to a hundredth, far beyond any play.
const WAY_OFF: f64 = 1e-4;
const WAYS_OFF: i32 = 8;
/// Names of the five directions.
const DIRECTION_NAMES: [&str; 5] = ["x", "y", "z", "ry", "rz"];

/// Quantity that a step of the search must lower.
#[derive(Clone, Copy, PartialEq)]
pub enum Progress {
    /// A smaller residual: quick, but a residual can have minima where there is no balance.
    Residual,
    /// Work done by the unbalanced loads: the potential falls, which leads out of such minima.
    Work,
}

/// Where a search ended.
pub struct Found<B = BallBalance> {
    /// Displacements and cage speed.
    pub unknowns: SharedVector,
    /// Forces there.
    pub trial: Trial<B>,
    /// [-] largest residual over the forces at work.
    pub residual: f64,
    /// Iterations spent.
    pub iterations: u32,
    /// Was the tolerance reached?
    pub converged: bool,
}

/// Budget and goal of a search.
#[derive(Clone, Copy)]
pub struct Effort {
    /// [-] residual over the size of the forces at work that is enough.
    pub tolerance: f64,
    /// [-] residual below which a step without progress ends the search.
    pub enough: f64,
    /// Most iterations on the displacements.
    pub iterations: u32,
}

/// A quasi-static problem with the sizes that make its residuals and steps comparable.
pub struct Problem<'a> {
    /// The bearing.
    pub model: &'a Model,
    /// Its conditions.
    pub input: &'a EquilibriumInput,
    /// [N, N m] what acts from outside on the race in the middle, where forces move it: its weight, a moving frame.
    outside: [f64; 5],
    /// \[m] ball diameter.
    diameter: f64,
    /// [rad/s] mean orbital speed of unloaded balls.
    epicyclic: f64,
    /// [rad/s] larger speed of the races.
    speed_scale: f64,
    /// \[N] forces that are known beforehand: loads, inertia, and the smallest load worth resolving.
    pub known_force: f64,
    /// \[N] the last of these: a ball loaded by an approach of a millionth of its diameter.
    smallest: f64,
}

impl<'a> Problem<'a> {
    /// The problem of a bearing under these conditions.
    pub fn new(model: &'a Model, input: &'a EquilibriumInput) -> Self {
        let bearing = &model.bearing;
        let length = model.race_length();
        let diameter = 2.0 * bearing.ball.radius;
        let epicyclic =
            bearing.epicyclic_speed(bearing.free_contact_angle, input.inner_speed, input.outer_speed);
        let smallest = model.contact(Race::Inner, &Conditions::default()).shape.stiffness(0.0)
            * (1e-6 * diameter).powf(1.5);
        let inertia_force = bearing.ball.mass * epicyclic * epicyclic * length;
        let mut problem = Self {
            model,
            input,
            outside: [0.0; 5],
            diameter,
            epicyclic,
            speed_scale: input.inner_speed.abs().max(input.outer_speed.abs()),
            known_force: inertia_force.max(smallest),
            smallest,
        };
        problem.outside = outside_of_race(model, input, &problem.centred()).map(D::value);
        for i in 0..5 {
            if let Some(load) = problem.imposed_load(i, &problem.outside) {
                problem.known_force = larger(problem.known_force, load.abs() / problem.size(i));
            }
        }
        problem
    }

    /// [-], \[m] length that turns a moment into a force and an angle into a displacement; 1 for translations.
    fn size(&self, direction: usize) -> f64 {
        if direction < 3 { 1.0 } else { self.model.race_length() }
    }

    /// [N, N m] load on the race in a direction, what acts from outside included; none where its motion is imposed.
    fn imposed_load(&self, direction: usize, outside: &[f64; 5]) -> Option<f64> {
        match self.input.conditions.get(direction) {
            Some(Prescribed::Load(load)) => Some(load + outside[direction]),
            _ => None,
        }
    }

    /// The race in the middle but for what is imposed on it.
    pub fn centred(&self) -> SharedVector {
        let mut unknowns = SharedVector::zeros();
        // An outer race starts in line with the inner one, which may be anywhere.
        if self.input.race == Race::Outer {
            let Pose { position, orientation } = &self.input.resting;
            unknowns.fixed_rows_mut::<3>(0).copy_from(position);
            unknowns.fixed_rows_mut::<2>(3).copy_from(&orientation.scaled_axis().yz());
        }
        for (i, condition) in self.input.conditions.iter().enumerate() {
            if let Prescribed::Motion(value) = condition {
                unknowns[i] = *value;
            }
        }
        unknowns[5] = self.epicyclic;
        unknowns
    }

    /// The race a thousandth of a ball diameter off the centre, where its loads push it.
    pub fn pushed(&self) -> SharedVector {
        let mut loads = SharedVector::zeros();
        for i in 0..5 {
            loads[i] = self.imposed_load(i, &self.outside).unwrap_or(0.0) / self.size(i);
        }
        let mut way = loads.normalize() * (1e-3 * self.diameter);
        for i in 0..5 {
            way[i] /= self.size(i);
        }
        // No load pushes nowhere.
        if loads.amax() > 0.0 { self.centred() + way } else { self.centred() }
    }

    /// \[N] size of the forces at work.
    fn reference<B>(&self, trial: &Trial<B>) -> f64 {
        self.known_force.max(trial.inner_load_sum)
    }

    /// Does a thrust settle where the race is that can tilt? Without one it can lie against either side of the grooves, and which
    /// one is found depends on where a search begins. So it may where it cannot tilt.
    pub fn is_settled_by_thrust(&self) -> bool {
        let free = |i: usize| matches!(self.input.conditions[i], Prescribed::Load(_));
        let load = |i: usize| self.imposed_load(i, &self.outside).unwrap_or(0.0);
        let tilts = free(3) || free(4);
        !tilts || (free(0) && load(0).abs() > SETTLING_THRUST * load(1).hypot(load(2)))
    }

    /// Unbalanced load of every free direction.
    fn unbalanced<B>(&self, trial: &Trial<B>) -> SharedVector {
        let outside = trial.outside.map(D::value);
        let of = |i| self.imposed_load(i, &outside).map_or(0.0, |load| load - trial.load[i]);
        SharedVector::from_fn(|i, _| if i < 5 { of(i) } else { 0.0 })
    }

    /// [-] residual: unbalanced loads over a force `scale` \[N], excess of the cage speed over a load `weight` \[N].
    fn residual_over<B>(&self, trial: &Trial<B>, scale: f64, weight: f64) -> SharedVector {
        let mut residual = self.unbalanced(trial);
        for i in 0..5 {
            residual[i] /= self.size(i) * scale;
        }
        if self.speed_scale > 0.0 {
            residual[5] = trial.cage_excess / (self.speed_scale * weight);
        }
        residual
    }

    /// [-] residual over the size of the forces at work.
    fn residual<B>(&self, trial: &Trial<B>) -> SharedVector {
        self.residual_over(trial, self.reference(trial), trial.inner_load_sum.max(1e-9 * self.smallest))
    }

    fn evaluate(&self, unknowns: &SharedVector, places: Option<&[Place]>) -> Result<Trial, EquilibriumError> {
        evaluate(self.model, self.input, unknowns, places, 0.01 * TOLERANCE * self.known_force)
    }

    /// The balance from a start: displacements, and places of the balls where they are known.
    pub fn search(
        &self,
        start: SharedVector,
        places: Option<&[Place]>,
        progress: Progress,
    ) -> Result<Found, EquilibriumError> {
        let effort = Effort { tolerance: TOLERANCE, enough: 0.0, iterations: MAX_ITERATIONS };
        let evaluate = |unknowns: &SharedVector, before: Option<&Trial>| {
            self.evaluate(unknowns, before.map(|trial| &*trial.places).or(places))
        };
        let found = self.descend(start, progress, effort, evaluate)?;
        if found.converged {
            return Ok(found);
        }
        // Downhill all the way to where no bearing is: that is the reason.
        if progress == Progress::Work {
            self.check(self.finish(&found))?;
        }
        let Found { unknowns, trial, residual, iterations, .. } = found;
        let direction = DIRECTION_NAMES[self.residual(&trial).rows(0, 5).iamax()];
        let displacement = std::array::from_fn(|i| unknowns[i]);
        Err(EquilibriumError::NoConvergence { residual, direction, iterations, displacement })
    }

    /// Newton's method with a shift of the stiffness where a step makes no progress; `evaluate` gives the forces at
    /// displacements, from those of the last accepted ones.
    pub fn descend<B>(
        &self,
        start: SharedVector,
        mut progress: Progress,
        effort: Effort,
        evaluate: impl Fn(&SharedVector, Option<&Trial<B>>) -> Result<Trial<B>, EquilibriumError>,
    ) -> Result<Found<B>, EquilibriumError> {
        let mut unknowns = start;
        let mut here = evaluate(&unknowns, None)?;
        let mut residual = self.residual(&here);
        let mut shift = 0.0;
        let mut iterations = 0;
        let reached = |residual: &SharedVector| largest(residual) <= effort.tolerance;
        while !reached(&residual) {
            iterations += 1;
            let trial = self.newton_step(&here, shift).and_then(|mut step| {
                // At most a hundredth of a ball diameter at a time.
                let longest = (0..5).map(|i| step[i].abs() * self.size(i)).fold(0.0, f64::max);
                let limit = 0.01 * self.diameter;
                if longest > limit {
                    step *= limit / longest;
                }
                let moved = unknowns + step;
                evaluate(&moved, Some(&here)).ok().map(|trial| (moved, trial))
            });
            match trial.filter(|(moved, trial)| self.accepts(progress, &here, trial, &(moved - unknowns))) {
                Some((moved, trial)) => {
                    unknowns = moved;
                    residual = self.residual(&trial);
                    here = trial;
                    shift = if shift < 1e-9 { 0.0 } else { shift * 0.1 };
                }
                None => shift = if shift == 0.0 { 1e-9 } else { shift * 5.0 },
            }
            // Round-off of the balls' places bounds what can be reached.
            let stalled = shift > if largest(&residual) < effort.enough { 0.0 } else { 1e12 };
            if stalled && largest(&residual) < 100.0 * effort.tolerance {
                break;
            }
            if stalled && progress == Progress::Work {
                // The bottom of a potential with kinks: the residual may know the rest of the way.
                progress = Progress::Residual;
                shift = 0.0;
            } else if stalled || iterations == effort.iterations {
                let residual = largest(&residual);
                return Ok(Found { unknowns, trial: here, residual, iterations, converged: false });
            }
        }
        Ok(Found { unknowns, trial: here, residual: largest(&residual), iterations, converged: true })
    }

    /// Is a step progress?
    fn accepts<B>(&self, progress: Progress, here: &Trial<B>, trial: &Trial<B>, step: &SharedVector) -> bool {
        // A race that touches nothing yet moves without its residual falling.
        let touches = |trial: &Trial<B>| trial.inner_load_sum > 1e-9 * self.reference(trial);
        if !touches(here) && !touches(trial) {
            return true;
        }
        // What has to fall is the residual over its own forces or with one scale for both: over its own forces alone, a
        // race that has to let go of its balls would seem further from balance the less it carries.
        let scale = self.reference(here);
        let merit = |trial: &Trial<B>| self.residual_over(trial, scale, scale).norm();
        let falls = |now: f64, before: f64| now < before * (1.0 - 1e-6);
        let smaller = falls(self.residual(trial).norm(), self.residual(here).norm())
            || falls(merit(trial), merit(here));
        if progress == Progress::Residual || largest(&self.residual(here)) < NEAR {
            return smaller;
        }
        // Work of the unbalanced loads by the trapezoidal rule; the cage speed takes no part in it.
        let (before, after) = (self.unbalanced(here), self.unbalanced(trial));
        let work = 0.5 * (before + after).dot(step);
        let size = before.component_mul(step).abs().sum();
        if size == 0.0 { smaller } else { work > 1e-6 * size }
    }

    /// Newton step of the free directions and the cage speed, its matrix shifted by `shift` typical stiffnesses.
    fn newton_step<B>(&self, here: &Trial<B>, shift: f64) -> Option<SharedVector> {
        // [N/m] of a steel bearing's order; only its order matters.
        const TYPICAL_STIFFNESS: f64 = 1e7;
        let mut matrix = here.tangent;
        let mut rhs = self.unbalanced(here);
        for (i, outside) in here.outside.iter().enumerate() {
            for k in 0..N_SHARED {
                matrix[(i, k)] -= outside.derivatives[SHARED + k];
            }
        }
        for i in 0..5 {
            if let Prescribed::Load(_) = self.input.conditions[i] {
                matrix[(i, i)] += shift * TYPICAL_STIFFNESS * self.size(i) * self.size(i);
            } else {
                matrix.row_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
            }
        }
        if self.speed_scale > 0.0 && here.inner_load_sum > 0.0 {
            rhs[5] = -here.cage_excess;
        } else {
            matrix.row_mut(5).fill(0.0);
            matrix[(5, 5)] = 1.0;
        }
        // Rows and columns of comparable size, so that pivoting compares like with like.
        let speed = self.speed_scale.max(1.0) / self.size(3);
        let column = SharedVector::from_fn(|i, _| if i < 5 { 1.0 / self.size(i) } else { speed });
        let scaled = matrix * SharedMatrix::from_diagonal(&column);
        let row = SharedVector::from_fn(|i, _| 1.0 / scaled.row(i).amax().max(f64::MIN_POSITIVE));
        let system = SharedMatrix::from_diagonal(&row) * scaled;
        let solution = system.lu().solve(&row.component_mul(&rhs))?;
        let step = column.component_mul(&solution);
        step.iter().all(|c| c.is_finite()).then_some(step)
    }

    /// [N/m] negative stiffness of an unstable balance, and the way \[-] along which it gives in; none where a balance is stable. That
    /// is of the symmetric part, angles times the size of the race.
    fn gives_in(&self, found: &Found) -> Option<(f64, SharedVector)> {
        let stiffness = self.stiffness(&found.trial);
        let free = |i: usize| matches!(self.input.conditions[i], Prescribed::Load(_));
        let largest = (0..5).filter(|i| free(*i)).map(|i| stiffness[(i, i)].abs()).fold(0.0, f64::max);
        let symmetric = SMatrix::<f64, 5, 5>::from_fn(|i, k| match (free(i) && free(k), i == k) {
            (true, _) => 0.5 * (stiffness[(i, k)] + stiffness[(k, i)]),
            // What is held does not give in.
            (false, true) => largest,
            (false, false) => 0.0,
        });
        if !symmetric.iter().all(|c| c.is_finite()) {
            return None;
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = symmetric.symmetric_eigen();
        let least = eigenvalues.imin();
        let way = eigenvectors.column(least);
        // Its sign says nothing: that of the largest component is made positive.
        let sign = way[way.iamax()].signum();
        let along = |i: usize| if i < 5 { sign * way[i] / self.size(i) } else { 0.0 };
        (eigenvalues[least] < -NO_STIFFNESS * largest)
            .then(|| (eigenvalues[least], SharedVector::from_fn(|i, _| along(i))))
    }

    /// [N/m] external load by displacement, cage speed and what acts from outside following; angles times the size of the race.
    fn stiffness(&self, trial: &Trial) -> SMatrix<f64, 5, 5> {
        let t = &trial.tangent;
        let by = |i: usize, k: usize| t[(i, k)] - trial.outside[i].derivatives[SHARED + k];
        SMatrix::from_fn(|i, k| {
            let follow = if t[(5, 5)] == 0.0 { 0.0 } else { by(i, 5) * t[(5, k)] / t[(5, 5)] };
            (by(i, k) - follow) / (self.size(i) * self.size(k))
        })
    }

    /// A stable balance beside an unstable one, such as a race that stands on the top of one ball: searched from further and further
    /// along the way on which that gives in, to both sides. The same where it is stable, or where none is found.
    pub fn off_the_top(&self, found: Found) -> Found {
        let Some((_, way)) = self.gives_in(&found) else { return found };
        let mut ways = (0..WAYS_OFF).flat_map(|double| [1.0, -1.0].map(|side| side * 2f64.powi(double)));
        let stable = ways.find_map(|times| {
            let start = found.unknowns + way * (times * WAY_OFF * self.diameter);
            let beside = self.search(start, Some(&found.trial.places), Progress::Residual).ok()?;
            let holds = self.gives_in(&beside).is_none() && self.check(self.finish(&beside)).is_ok();
            holds.then_some(beside)
        });
        stable.unwrap_or(found)
    }

    /// The solution as it is reported.
    pub fn finish(&self, found: &Found) -> Equilibrium {
        let Found { unknowns, trial, residual, iterations, .. } = found;
        let unstable = self.gives_in(found).map(|(stiffness, _)| stiffness);
        Equilibrium { unstable, ..finish(self.model, self.input, unknowns, trial, *residual, *iterations) }
    }

    /// Refuses contacts that Hertz's theory does not reach, or that lie where no groove is.
    pub fn check(&self, solution: Equilibrium) -> Result<Equilibrium, EquilibriumError> {
        let [least, greatest] = self.model.bearing.contact_angles();
        let loads = solution.balls.iter().map(|ball| ball.report.inner_load.max(ball.report.outer_load));
        let most = loads.fold(0.0, f64::max);
        for (index, ball) in solution.balls.iter().enumerate() {
            let b = &ball.report;
            let (approach, load) = (b.inner_approach.max(b.outer_approach), b.inner_load.max(b.outer_load));
            if approach > MAX_APPROACH * self.diameter {
                let ball = index + 1;
                return Err(EquilibriumError::Overload { ball, approach, load, limit: MAX_APPROACH });
            }
            let contacts = [
                ("inner", b.inner_load, b.inner_contact_angle),
                ("outer", b.outer_load, b.outer_contact_angle),
            ];
            for (race, load, angle) in contacts {
                if load > 0.0 && !(least..=greatest).contains(&angle) {
                    let (ball, limit) = (index + 1, if angle < least { least } else { greatest });
                    return Err(EquilibriumError::LeftGroove { ball, race, load, most, angle, limit });
                }
            }
        }
        for (race, form) in
            Race::BOTH.into_iter().filter_map(|race| Some((race, self.model.form[race].as_ref()?)))
        {
            for (index, ball) in solution.balls.iter().enumerate() {
                let (order, span) = (form.order, ball.report.spans[race]);
                if order * span > SHORTEST {
                    let (race, ball, longest) = (race.name(), index + 1, (SHORTEST / span).floor());
                    return Err(EquilibriumError::ShortWave { race, order, ball, span, longest });
                }
            }
        }
        let on = |race| solution.balls.iter().map(move |ball| ball.report.on(race));
        for race in Race::BOTH {
            self.model.bearing.check_shoulders(race, on(race).map(|(load, _)| load), |ball| {
                solution.balls[ball].report.on(race).1
            })?;
        }
        Ok(solution)
    }
}
