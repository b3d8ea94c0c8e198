//! Balls of a trial step, four at a time: motion, contacts, forces and residual of each group in the lanes of vectors.
//!
//! Only what few balls need is kept ball by ball ([`BallTrial`](super::ball::BallTrial)).

use nalgebra::{Vector3, Vector6};

use super::ball_equations::BallEquations;
use super::spacing::{Apart, Share, SpacingTrial, Turn};
use crate::contact::many::{ContactGroup, Touch};
use crate::contact::pair::PairForces;
use crate::contact::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::effects::ambient::Ambient;
use crate::model::bearing::Ball;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::BallState;
use crate::numerics::arrowhead::{BLOCK, Six};
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::Scalar;

/// Up to [`WIDTH`] balls in one trial step. Lanes without a ball repeat the last.
#[derive(Clone, Debug)]
pub struct BallGroup {
    equations: BallEquations<Lanes>,
    unknowns: Six<Lanes>,
    motion: BallMotion<Lanes>,
    /// Contacts with the races.
    contacts: PerRace<ContactGroup>,
    /// Which balls are to be evaluated, as they have moved since then?
    pub moved: [bool; WIDTH],
    balance: Balance,
    /// Where an ideal cage keeps them, and what they add to its turn.
    apart: Option<(Apart<Lanes>, Share<Lanes>)>,
}

/// Forces on balls, and what is left of their equations.
#[derive(Clone, Debug)]
struct Balance {
    total: Wrench<Lanes>,
    remainder: Wrench<Lanes>,
    residual: Six<Lanes>,
    /// \[N] largest component of the residual.
    size: Lanes,
}

impl BallGroup {
    /// Buffers for balls with these equations, and contacts of any kind.
    fn new(equations: &BallEquations<Lanes>, contacts: &PerRace<ContactGroup>) -> Self {
        let zero = Lanes::constant(0.0);
        let unknowns = [zero; 6];
        let balance = Balance {
            total: Wrench::default(),
            remainder: Wrench::default(),
            residual: unknowns,
            size: zero,
        };
        Self {
            equations: *equations,
            unknowns,
            motion: equations.motion(&unknowns),
            contacts: contacts.clone(),
            moved: [true; WIDTH],
            balance,
            apart: None,
        }
    }

    /// Moves its balls to the end of the step: `unknowns` are those of all its balls. Notes which moved, or that `all` count as moved.
    fn move_to(&mut self, unknowns: &[f64], all: bool) {
        let balls = unknowns.len() / BLOCK;
        let Self { equations, unknowns: own, motion, moved, apart, .. } = self;
        let changed = move_to_lanes(equations, unknowns, own, motion);
        if let Some((apart, _)) = apart {
            keep_apart_lanes(apart, own, motion);
        }
        *moved = std::array::from_fn(|lane| lane < balls && (all || moved[lane] || changed[lane]));
    }

    /// Moves its balls by a last correction that is not evaluated: forces follow as their derivatives say, and leave nothing.
    fn settle(&mut self, unknowns: &[f64]) {
        let Self { equations, unknowns: own, motion, balance, .. } = self;
        let settled = move_to_lanes(equations, unknowns, own, motion);
        let total = equations.total_in_balance(own);
        for lane in (0..WIDTH).filter(|lane| settled[*lane]) {
            put_wrench(&mut balance.total, lane, &wrench_in_lane(&total, lane));
            put_wrench(&mut balance.remainder, lane, &Wrench::default());
        }
    }

    /// Evaluates the contacts of its balls with a race.
    pub fn evaluate(&mut self, race: Race, contact: &ContactModel<'_>, seen: &RaceMotion<f64>) {
        self.contacts[race].evaluate(contact, seen, &self.motion);
    }

    /// Takes over the contact of the ball in a lane with a race, evaluated elsewhere.
    pub fn set(&mut self, race: Race, lane: usize, contact: &BallRaceContact<f64>) {
        self.contacts[race].set(lane, contact);
    }

    /// Forces on its balls by their contacts, by what acts from outside, and by pockets and neighbours; what they leave.
    pub fn balance(&mut self, ambient: &Ambient, touched: Option<&[Wrench<Lanes>; 2]>) {
        self.moved = [false; WIDTH];
        let contacts = [Race::Inner, Race::Outer].map(|race| self.contacts[race].lanes());
        let at = (&self.unknowns, &self.motion);
        balance_lanes(&self.equations, at, (ambient, contacts, touched), &mut self.balance);
        if let Some((apart, share)) = &mut self.apart {
            balance_apart_lanes(apart, &self.unknowns, &mut self.balance, share);
        }
    }

    /// Motion of its balls.
    pub fn motions(&self) -> &BallMotion<Lanes> {
        &self.motion
    }

    /// Motion of the ball in a lane.
    #[inline]
    pub fn motion(&self, lane: usize) -> BallMotion<f64> {
        let BallMotion { position, velocity, angular_velocity } = &self.motion;
        let [position, velocity, angular_velocity] =
            [position, velocity, angular_velocity].map(|v| in_lane(v, lane));
        BallMotion { position, velocity, angular_velocity }
    }
}

/// All balls of a trial step.
#[derive(Clone, Debug, Default)]
pub struct Groups(Vec<BallGroup>);

impl Groups {
    /// Begins a step of these balls. `contact` gives contacts to fill new buffers with.
    pub fn begin(
        &mut self,
        balls: &[BallState],
        (ball, step): (&Ball, &HhtStep),
        contact: impl FnOnce() -> PerRace<ContactGroup>,
    ) {
        if self.0.len() != balls.len().div_ceil(WIDTH) {
            let contacts = contact();
            let of_group = |balls: &[BallState]| {
                let equations = BallEquations::of_lanes(|lane| lane_of(balls, lane), ball, step);
                BallGroup::new(&equations, &contacts)
            };
            self.0 = balls.chunks(WIDTH).map(of_group).collect();
        }
        for (group, balls) in self.0.iter_mut().zip(balls.chunks(WIDTH)) {
            begin_lanes(balls, (ball, step), &mut group.equations);
        }
    }

    /// Begins the step of these balls where an ideal cage keeps them apart: by the azimuths of all where its turn is 0.
    pub fn keep_apart(
        &mut self,
        balls: &[BallState],
        azimuths: &[[f64; 2]],
        trial: &SpacingTrial,
        (ball, step): (&Ball, &HhtStep),
    ) {
        let of_groups = balls.chunks(WIDTH).zip(azimuths.chunks(WIDTH));
        for (group, of_group) in self.0.iter_mut().zip(of_groups) {
            begin_apart_lanes(of_group, trial, (ball.mass, step), &mut group.apart);
        }
    }

    /// Turns the balls that an ideal cage keeps apart; they move there with their unknowns.
    pub fn turn(&mut self, turn: &Turn) {
        self.0.iter_mut().filter_map(|group| group.apart.as_mut()).for_each(|(apart, _)| apart.follow(turn));
    }

    /// Where an ideal cage keeps a ball.
    pub fn apart(&self, ball: usize) -> Option<Apart<f64>> {
        let (group, lane) = self.place(ball);
        group.apart.as_ref().map(|(apart, _)| apart.in_lane(lane))
    }

    /// Shares of the balls in the turn of an ideal cage, group by group.
    pub fn shares(&self) -> impl Iterator<Item = &Share<Lanes>> {
        self.0.iter().filter_map(|group| group.apart.as_ref().map(|(_, share)| share))
    }

    /// [m/s2] acceleration of a ball along its orbit by that of the turn of an ideal cage [rad/s2].
    pub fn along_orbit(&self, ball: usize) -> Option<Vector3<f64>> {
        let (group, lane) = self.place(ball);
        group.apart.as_ref().map(|(apart, share)| apart.along(lane) * share.radius.0[lane])
    }

    /// Moves one ball somewhere else.
    pub fn put(&mut self, ball: usize, unknowns: &Vector6<f64>) {
        let (group, lane) = (&mut self.0[ball / WIDTH], ball % WIDTH);
        for (lanes, unknown) in group.unknowns.iter_mut().zip(unknowns) {
            lanes.0[lane] = *unknown;
        }
        group.moved[lane] = true;
        move_lanes(&group.equations, &group.unknowns, &mut group.motion);
        if let Some((apart, _)) = &group.apart {
            keep_apart_lanes(apart, &group.unknowns, &mut group.motion);
        }
    }

    /// Moves the balls to the end of the step; `all` count as moved, or those whose unknowns have changed.
    pub fn move_to(&mut self, unknowns: &[f64], all: bool) {
        for (group, unknowns) in self.0.iter_mut().zip(unknowns.chunks(BLOCK * WIDTH)) {
            group.move_to(unknowns, all);
        }
    }

    /// Moves the balls by a last correction that is not evaluated ([`super::last_correction`]).
    pub fn settle(&mut self, unknowns: &[f64]) {
        for (group, unknowns) in self.0.iter_mut().zip(unknowns.chunks(BLOCK * WIDTH)) {
            group.settle(unknowns);
        }
    }

    /// The groups.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut BallGroup> {
        self.0.iter_mut()
    }

    #[inline]
    fn place(&self, ball: usize) -> (&BallGroup, usize) {
        (&self.0[ball / WIDTH], ball % WIDTH)
    }

    /// [m/s2] acceleration of a ball's centre, and its angular acceleration times its radius.
    #[inline]
    pub fn unknowns(&self, ball: usize) -> Vector6<f64> {
        let (group, lane) = self.place(ball);
        six_in_lane(&group.unknowns, lane)
    }

    /// Motion of a ball at the end of the step.
    #[inline]
    pub fn motion(&self, ball: usize) -> BallMotion<f64> {
        let (group, lane) = self.place(ball);
        group.motion(lane)
    }

    /// \[m] centre of a ball at the end of the step.
    #[inline]
    pub fn position(&self, ball: usize) -> Vector3<f64> {
        let (group, lane) = self.place(ball);
        in_lane(&group.motion.position, lane)
    }

    /// Forces between a ball and a race.
    #[inline]
    pub fn pair(&self, ball: usize, race: Race) -> PairForces {
        let (group, lane) = self.place(ball);
        group.contacts[race].forces(lane)
    }

    /// Force and moment of so many balls on a race, summed from the first to the last.
    pub fn on_race(&self, race: Race, balls: usize) -> Wrench {
        let mut sum = Wrench::default();
        for (index, group) in self.0.iter().enumerate() {
            let contact = group.contacts[race].lanes();
            for lane in 0..WIDTH.min(balls - WIDTH * index) {
                for i in 0..3 {
                    sum.force[i] -= contact.force[i].0[lane];
                    sum.moment[i] += contact.race_moment[i].0[lane];
                }
            }
        }
        sum
    }

    /// Approach \[m] and load \[N] of a ball on a race.
    #[inline]
    pub fn pressed(&self, ball: usize, race: Race) -> (f64, f64) {
        let (group, lane) = self.place(ball);
        let contact = group.contacts[race].lanes();
        (contact.geometry.approach.0[lane], contact.load.0[lane])
    }

    /// Centres of the balls at the end of the step \[m], group by group.
    pub fn positions(&self) -> impl Iterator<Item = &Vector3<Lanes>> {
        self.0.iter().map(|group| &group.motion.position)
    }

    /// Residuals of the balls \[N] and their largest components, group by group.
    pub fn residuals(&self) -> impl Iterator<Item = (&Six<Lanes>, &Lanes)> {
        self.0.iter().map(|group| (&group.balance.residual, &group.balance.size))
    }

    /// Where a ball touches a race.
    #[inline]
    pub fn touch(&self, ball: usize, race: Race) -> Touch {
        let (group, lane) = self.place(ball);
        group.contacts[race].touch(lane)
    }

    /// Did a ball, or one of those next to it, roll obliquely on a race when it was evaluated last?
    #[inline]
    pub fn rolled_obliquely(&self, ball: usize, race: Race) -> bool {
        self.place(ball).0.contacts[race].rolled_obliquely()
    }

    /// Contacts of a ball with the races.
    pub fn contacts(&self, ball: usize) -> PerRace<BallRaceContact<f64>> {
        let (group, lane) = self.place(ball);
        PerRace::new(|race| group.contacts[race].contact(lane))
    }

    /// Total force and moment on a ball.
    #[inline]
    pub fn total(&self, ball: usize) -> Wrench {
        let (group, lane) = self.place(ball);
        wrench_in_lane(&group.balance.total, lane)
    }

    /// Remainder of a ball's equations of motion.
    #[inline]
    pub fn remainder(&self, ball: usize) -> Wrench {
        let (group, lane) = self.place(ball);
        wrench_in_lane(&group.balance.remainder, lane)
    }

    /// \[N] residual of a ball; moments over its radius.
    #[inline]
    pub fn residual(&self, ball: usize) -> Vector6<f64> {
        let (group, lane) = self.place(ball);
        six_in_lane(&group.balance.residual, lane)
    }

    /// \[N] largest component of a ball's residual; NaN if one is.
    #[inline]
    pub fn size(&self, ball: usize) -> f64 {
        let (group, lane) = self.place(ball);
        group.balance.size.0[lane]
    }
}

/// The ball of a lane: lanes without one repeat the last.
#[inline(always)]
fn lane_of<T>(balls: &[T], lane: usize) -> &T {
    &balls[lane.min(balls.len() - 1)]
}

/// Equations of balls at the start of a step. Compiled twice, as contacts are ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn begin_lanes(balls: &[BallState], (ball, step): (&Ball, &HhtStep), equations: &mut BallEquations<Lanes>) {
    *equations = BallEquations::of_lanes(|lane| lane_of(balls, lane), ball, step);
}

/// Moves the balls to unknowns that are given ball by ball; which lanes have other unknowns than before?
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn move_to_lanes(
    equations: &BallEquations<Lanes>,
    given: &[f64],
    unknowns: &mut Six<Lanes>,
    motion: &mut BallMotion<Lanes>,
) -> [bool; WIDTH] {
    let given = given.as_chunks::<BLOCK>().0;
    let lane = |lane: usize| lane_of(given, lane);
    let of_lane = [lane(0), lane(1), lane(2), lane(3)];
    let mut changed = [false; WIDTH];
    for k in 0..BLOCK {
        let new = Lanes([of_lane[0][k], of_lane[1][k], of_lane[2][k], of_lane[3][k]]);
        for (lane, changed) in changed.iter_mut().enumerate() {
            *changed |= new.0[lane] != unknowns[k].0[lane];
        }
        unknowns[k] = new;
    }
    *motion = equations.motion(unknowns);
    changed
}

/// Moves balls.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn move_lanes(equations: &BallEquations<Lanes>, unknowns: &Six<Lanes>, motion: &mut BallMotion<Lanes>) {
    *motion = equations.motion(unknowns);
}

/// Balls of a group at the start of a step in which an ideal cage keeps them apart, by their azimuths.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn begin_apart_lanes(
    (balls, azimuths): (&[BallState], &[[f64; 2]]),
    trial: &SpacingTrial,
    (mass, step): (f64, &HhtStep),
    apart: &mut Option<(Apart<Lanes>, Share<Lanes>)>,
) {
    let lane = |lane: usize| (lane_of(balls, lane), *lane_of(azimuths, lane));
    let zero = Lanes::constant(0.0);
    let share = Share { inertia: zero, moment: zero, radius: zero };
    *apart = Some((Apart::new(lane, trial, mass, step), share));
}

/// Puts balls where an ideal cage keeps them.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn keep_apart_lanes(apart: &Apart<Lanes>, unknowns: &Six<Lanes>, motion: &mut BallMotion<Lanes>) {
    apart.move_to(unknowns, motion);
}

/// Residuals of balls that an ideal cage keeps apart.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn balance_apart_lanes(
    apart: &Apart<Lanes>,
    unknowns: &Six<Lanes>,
    balance: &mut Balance,
    share: &mut Share<Lanes>,
) {
    let Balance { total, remainder, residual, size } = balance;
    *share = apart.balance(unknowns, total, remainder, residual);
    *size = residual.iter().fold(Lanes::constant(0.0), |size, x| size.larger_size(*x));
}

/// Forces on balls: from outside, by two contacts, and by pockets and neighbours where some touch.
type Acts<'a> = (&'a Ambient, [&'a BallRaceContact<Lanes>; 2], Option<&'a [Wrench<Lanes>; 2]>);

/// Sums what acts on balls with these unknowns and this motion, and what it leaves of their equations.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn balance_lanes(
    equations: &BallEquations<Lanes>,
    (unknowns, motion): (&Six<Lanes>, &BallMotion<Lanes>),
    (ambient, contacts, touched): Acts<'_>,
    balance: &mut Balance,
) {
    // Component by component where they stay: copies of what was written in other widths would wait for it.
    let Balance { total, remainder, residual, size } = balance;
    *total = ambient.on_ball(motion);
    for contact in contacts {
        for i in 0..3 {
            total.force[i] += contact.force[i];
            total.moment[i] += contact.ball_moment[i];
        }
    }
    for more in touched.into_iter().flatten() {
        for i in 0..3 {
            total.force[i] += more.force[i];
            total.moment[i] += more.moment[i];
        }
    }
    *remainder = equations.remainder(unknowns, total);
    *residual = equations.residual(remainder);
    *size = residual.iter().fold(Lanes::constant(0.0), |size, x| size.larger_size(*x));
}

#[inline(always)]
fn in_lane(v: &Vector3<Lanes>, lane: usize) -> Vector3<f64> {
    Vector3::new(v.x.0[lane], v.y.0[lane], v.z.0[lane])
}

#[inline(always)]
fn wrench_in_lane(wrench: &Wrench<Lanes>, lane: usize) -> Wrench {
    Wrench { force: in_lane(&wrench.force, lane), moment: in_lane(&wrench.moment, lane) }
}

#[inline(always)]
fn put_wrench(lanes: &mut Wrench<Lanes>, lane: usize, wrench: &Wrench) {
    for i in 0..3 {
        lanes.force[i].0[lane] = wrench.force[i];
        lanes.moment[i].0[lane] = wrench.moment[i];
    }
}

#[inline(always)]
fn six_in_lane(six: &Six<Lanes>, lane: usize) -> Vector6<f64> {
    Vector6::from_fn(|k, _| six[k].0[lane])
}
