//! The gates that every hard case passes, and the row of figures that it prints.
//!
//! (a) it finishes; (b) energy balance; (c) half the step cap; (d) nothing impossible, nothing unconverged; (e) replay
//! to the same bits; (g) bounded rejections. Gate (f), no gain of energy, has cases of its own.

use nalgebra::Vector3;
use roulement::forces::Contacts;
use roulement::interface::variables::Variables;
use roulement::model::bodies::{Body, Race};
use roulement::model::state::{BodyState, State, Statistics};
use roulement::numerics::motion::Wrench;
use roulement::scene::{CreepLaw, Scene};
use roulement::simulation::outputs::{ContactOutput, Outputs};
use roulement::simulation::{Simulation, Snapshot};

use roulement::simulation::inputs::Inputs;

use crate::figures;

/// (b) largest residual of the energy balance over work plus friction.
const ENERGY: f64 = 0.01;
/// (c) largest change of a window mean when the step cap is halved.
const CAP: f64 = 0.02;

/// [-] price of a matrix of all balls over that of a correction by an old one (benches/speed.rs).
const MATRIX: f64 = 5.0;

/// Inputs at the start of communication step `i`, and the end of the step [s].
pub type Importer<'a> = dyn Fn(&Simulation, u32) -> (Inputs, f64) + 'a;

/// (g) what a run may cost: a regression of robustness shows here although the result may still pass.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Steps, accepted.
    pub steps: u64,
    /// Steps rejected for their local error.
    pub rejected: u64,
    /// Solves in which Newton's method failed.
    pub failed: u64,
    /// Newton corrections per accepted step beside one matrix; further matrices count as [`MATRIX`] of them.
    pub corrections: f64,
}

/// Limits in the order of the table's columns.
pub fn limits(steps: u64, rejected: u64, failed: u64, corrections: f64) -> Limits {
    Limits { steps, rejected, failed, corrections }
}

/// A case: a scene, who moves it, and in which part of the run its means are taken.
pub struct Case<'a> {
    /// As it stands in the table of figures.
    pub name: &'a str,
    /// Scene.
    pub scene: Scene,
    /// Who sets the inputs; `None` is the scene's own script.
    pub importer: Option<&'a Importer<'a>>,
    /// [m] displacement of the whole bearing at the start, for races with given poses.
    pub displaced: Vector3<f64>,
    /// [m/s2] gravity from just after the start on.
    pub late_gravity: Option<[f64; 3]>,
    /// Communication steps.
    pub points: u32,
    /// Of how many communication points one is looked at.
    pub every: u32,
    /// Window of the means, as fractions of the points.
    pub window: [f64; 2],
    /// Does the cage knock to and fro without rule? Where it is in the mean is then another one with any other steps: (c) leaves that out.
    pub rattles: bool,
    /// (g).
    pub limits: Limits,
}

/// A run that went to its end.
pub struct Run {
    /// At the end.
    pub simulation: Simulation,
    /// Outputs at every communication point, the start included.
    pub history: Vec<Outputs>,
}

impl Run {
    /// Outputs at the end.
    pub fn last(&self) -> &Outputs {
        &self.history[self.history.len() - 1]
    }
}

impl<'a> Case<'a> {
    /// A case that the scene's own script runs, means over its second half.
    pub fn new(name: &'a str, scene: Scene, limits: Limits) -> Self {
        let points = (scene.load.duration.0 / scene.load.output_interval.0).round() as u32;
        Self {
            name,
            scene,
            importer: None,
            displaced: Vector3::zeros(),
            late_gravity: None,
            points,
            every: 1,
            window: [0.5, 1.0],
            rattles: false,
            limits,
        }
    }

    /// Runs the case through all gates.
    pub fn pass(&self) -> Run {
        let variables = Variables::moving(&self.scene, true);
        let mut snapshot = None;
        let fresh = self.simulation(&self.scene);
        let run = self.run_from(fresh.clone(), |simulation, point| {
            possible(self.name, simulation, &variables);
            converged(self.name, simulation);
            if point == self.replay_from() {
                snapshot = Some(simulation.snapshot());
            }
        });
        let snapshot = snapshot.expect("a run has a third quarter");
        self.replay(fresh, &run, &snapshot);

        let energy = energy_residual(&run.history);
        let statistics = run.simulation.state().statistics;
        let mean_step = self.mean_step(&run);
        let mut half = self.scene.clone();
        half.solver.max_step.0 = 0.5 * mean_step.min(half.solver.max_step.0);
        half.solver.initial_step.0 = half.solver.initial_step.0.min(half.solver.max_step.0);
        let finer = self.run(&half, |_, _| {});
        let (change, what) = self.change(&run.history, &finer.history);

        self.print(&run, energy, change);
        assert!(energy < ENERGY, "{}: energy balance open by {energy:.2e}", self.name);
        assert!(change < CAP, "{}: {what}, by {change:.2e}, with half the step cap", self.name);
        self.bounded(&run.simulation);
        let simulated = number(run.simulation.time() - run.history[0].time);
        figures::compare_case(self.name, &simulated, &statistics);
        run
    }

    fn simulation(&self, scene: &Scene) -> Simulation {
        let mut simulation = Simulation::new(scene).unwrap_or_else(|why| panic!("{}: {why}", self.name));
        if let Some(gravity) = self.late_gravity {
            let mut later = scene.clone();
            later.effects.gravity.acceleration = gravity.into();
            simulation.tune(&later);
        }
        if self.displaced != Vector3::zeros() {
            let mut inputs = *simulation.inputs();
            inputs.inner.pose.position += self.displaced;
            inputs.outer.pose.position += self.displaced;
            simulation.set_inputs(inputs);
            simulation.initialise().unwrap_or_else(|why| panic!("{}: {why}", self.name));
        }
        simulation
    }

    /// (a) the case runs to its end; `look` sees it at every communication point.
    pub fn run(&self, scene: &Scene, look: impl FnMut(&Simulation, u32)) -> Run {
        self.run_from(self.simulation(scene), look)
    }

    fn run_from(&self, mut simulation: Simulation, mut look: impl FnMut(&Simulation, u32)) -> Run {
        let mut history = vec![simulation.outputs().clone()];
        look(&simulation, 0);
        for point in 0..self.points {
            self.step(&mut simulation, point);
            if (point + 1) % self.every == 0 {
                look(&simulation, point + 1);
                history.push(simulation.outputs().clone());
            }
        }
        Run { simulation, history }
    }

    fn step(&self, simulation: &mut Simulation, point: u32) {
        let (inputs, end) = match self.importer {
            Some(importer) => importer(simulation, point),
            None => {
                let end = f64::from(point + 1) * self.scene.load.output_interval.0;
                (simulation.scripted_inputs(simulation.time()), end)
            }
        };
        simulation.set_inputs(inputs);
        simulation.advance(end).unwrap_or_else(|why| {
            let statistics = simulation.state().statistics;
            panic!("{}: {why}, {statistics:?}", self.name)
        });
    }

    /// (e) from a saved state, in an instance that never was there, to the same bits.
    fn replay(&self, mut other: Simulation, run: &Run, snapshot: &Snapshot) {
        assert!(other.restore(snapshot), "{}", self.name);
        for point in self.replay_from()..self.points {
            self.step(&mut other, point);
        }
        assert!(other.state() == run.simulation.state(), "{}: the replay differs", self.name);
        assert!(other.outputs() == run.simulation.outputs(), "{}: the replay differs", self.name);
    }

    /// The point looked at from which the replay starts, at about three quarters.
    fn replay_from(&self) -> u32 {
        self.points * 3 / 4 / self.every * self.every
    }

    fn mean_step(&self, run: &Run) -> f64 {
        let simulated = run.simulation.time() - run.history[0].time;
        simulated / run.simulation.state().statistics.steps as f64
    }

    /// (c) over the window.
    fn change(&self, one: &[Outputs], other: &[Outputs]) -> (f64, String) {
        let index = |fraction: f64| (fraction * (one.len() - 1) as f64).round() as usize;
        let [from, to] = self.window.map(index);
        let left_out = if self.rattles { ECCENTRICITY } else { "" };
        let arm = 0.5 * self.scene.bearing.pitch_diameter.0;
        change_but(&one[from..=to], &other[from..=to], arm, left_out)
    }

    fn print(&self, run: &Run, energy: f64, change: f64) {
        let s = run.simulation.state().statistics;
        println!(
            "\n| {} | {} | {} | {:.2} | {} | {} | {:.2} | {energy:.0e} | {change:.0e} |",
            self.name,
            number(run.simulation.time() - run.history[0].time),
            s.steps,
            self.mean_step(run) * 1e6,
            s.rejected_error,
            failed(&s),
            corrections(&s),
        );
    }

    /// (g).
    fn bounded(&self, simulation: &Simulation) {
        let (limits, s) = (&self.limits, &simulation.state().statistics);
        let contacts = (2 * simulation.state().balls.len()) as f64 * s.steps as f64;
        let price = corrections(s) + MATRIX * s.contact_tangents as f64 / contacts;
        let inside = s.steps <= limits.steps
            && s.rejected_error <= limits.rejected
            && failed(s) <= limits.failed
            && price <= limits.corrections + MATRIX;
        assert!(inside, "{}: {s:?}, price {price:.2}, is beyond {limits:?}", self.name);
    }
}

fn number(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.4} ms", seconds * 1e3) } else { format!("{seconds:.1} s") }
}

/// A rejected step has failed twice, from both first guesses.
pub fn failed(s: &Statistics) -> u64 {
    s.second_guesses + s.rejected_newton
}

pub fn corrections(s: &Statistics) -> f64 {
    s.newton.iterations as f64 / s.steps as f64
}

/// (b) residual of the energy balance at its worst over work plus friction.
///
/// Work that goes in and comes back counts each time, so that a reversal is not measured by what remains of it.
pub fn energy_residual(history: &[Outputs]) -> f64 {
    let first = &history[0];
    let residual = |o: &Outputs| {
        o.work - first.work - (o.dissipated - first.dissipated) - (o.stored_energy - first.stored_energy)
    };
    let work: f64 = history.windows(2).map(|pair| (pair[1].work - pair[0].work).abs()).sum();
    let reference = work + history[history.len() - 1].dissipated - first.dissipated;
    let worst = history.iter().map(|o| residual(o).abs()).fold(0.0, f64::max);
    // Below a nanojoule there is nothing but rounding to balance.
    worst / reference.max(1e-9)
}

/// (c) largest change of a window mean over the size of what it is a mean of, and which; `arm` [m] is the
/// radius of the pitch circle.
pub fn change(one: &[Outputs], other: &[Outputs], arm: f64) -> (f64, String) {
    change_but(one, other, arm, "")
}

/// The same but for the mean of a name.
fn change_but(one: &[Outputs], other: &[Outputs], arm: f64, left_out: &str) -> (f64, String) {
    let [a, b] = [one, other].map(|window| {
        let mut means = means(window, arm);
        means.retain(|mean| mean.name != left_out);
        means
    });
    let change = |i: usize| (a[i].mean - b[i].mean).abs() / a[i].size;
    let largest = (0..a.len()).max_by(|&i, &k| change(i).total_cmp(&change(k))).unwrap();
    let (name, was, is) = (a[largest].name, a[largest].mean, b[largest].mean);
    (change(largest), format!("{name} from {was:e} to {is:e}"))
}

/// Name of the mean of where a cage is.
const ECCENTRICITY: &str = "mean eccentricity of the cage";

struct Mean {
    name: &'static str,
    mean: f64,
    size: f64,
}

/// Means of what a user reads off a run, each with the mean size that a change is compared with.
fn means(window: &[Outputs], arm: f64) -> Vec<Mean> {
    let n = window.len() as f64;
    let mean = |get: &dyn Fn(&Outputs) -> f64| window.iter().map(get).sum::<f64>() / n;
    let load = |get: fn(&roulement::simulation::outputs::BallOutput) -> f64| {
        mean(&|o| o.balls.iter().map(get).sum::<f64>())
    };
    let force = mean(&|o| o.inner.wrench.force.norm());
    let inner = load(|ball| ball.inner.load);
    let outer = load(|ball| ball.outer.load);
    // Floors: what is smaller than a millionth of a newton, of a rad/s, of a watt is zero.
    // The turning of a cage is compared with all its motion: one that falls at standstill hardly turns.
    let falling = mean(&|o| o.cage.as_ref().map_or(0.0, |cage| cage.twist.velocity.norm())) / arm;
    let speed_size = (mean(&|o| o.cage_speed.abs()) + falling).max(1e-6);
    let force_size = force.max(1e-6);
    let (first, last) = (&window[0], &window[window.len() - 1]);
    let lost = (last.dissipated - first.dissipated) / (last.time - first.time);
    let mut list = vec![
        Mean { name: "mean inner load", mean: inner, size: inner.max(1e-6) },
        Mean { name: "mean outer load", mean: outer, size: outer.max(1e-6) },
        Mean { name: "mean cage speed", mean: mean(&|o| o.cage_speed), size: speed_size },
        Mean { name: "mean power lost", mean: lost, size: lost.abs().max(1e-6) },
    ];
    // A moment is compared with that of the forces at the pitch circle, where the balls are.
    let moment_size = force_size * arm;
    for (i, name) in ["mean moment x", "mean moment y", "mean moment z"].into_iter().enumerate() {
        list.push(Mean { name, mean: mean(&|o| o.inner.wrench.moment[i]), size: moment_size });
    }
    if window[0].cage.is_some() {
        let off = mean(&|o| o.cage.as_ref().map_or(0.0, |cage| cage.eccentricity.yz().norm()));
        list.push(Mean { name: ECCENTRICITY, mean: off, size: off.max(1e-9) });
    }
    for (i, name) in ["mean force x", "mean force y", "mean force z"].into_iter().enumerate() {
        list.push(Mean { name, mean: mean(&|o| o.inner.wrench.force[i]), size: force_size });
    }
    list
}

/// (d) finite everywhere, no pulling contact, no friction above its limit.
pub fn possible(name: &str, simulation: &Simulation, variables: &Variables) {
    let (inputs, outputs) = (simulation.inputs(), simulation.outputs());
    for (row, value) in variables.rows().iter().zip(variables.values(inputs, outputs)) {
        assert!(value.is_finite(), "{name}: {} = {value} at {} s", row.name, outputs.time);
    }
    let bounded = simulation.scene().effects.creep.law != CreepLaw::Linear;
    let holds = |contact: &ContactOutput| {
        let force = contact.force_longitudinal.hypot(contact.force_lateral);
        let limit = inputs.friction * contact.load;
        contact.load >= 0.0 && (!bounded || force <= limit * (1.0 + 1e-12))
    };
    for ball in &outputs.balls {
        assert!(holds(&ball.inner) && holds(&ball.outer), "{name}: {ball:?} at {} s", outputs.time);
    }
    let friction = &simulation.scene().friction;
    let oiled = simulation.model().oil_around_cage(&simulation.conditions()) > 0.0;
    let pushes = |force: &Vector3<f64>, load: f64, friction: Option<f64>| {
        let limit = load * friction.unwrap_or(inputs.friction).hypot(1.0);
        // Films press and drag where nothing touches.
        load >= 0.0 && (oiled || force.norm() <= limit * (1.0 + 1e-12))
    };
    for pocket in outputs.balls.iter().filter_map(|ball| ball.pocket) {
        let pushes = pushes(&pocket.force, pocket.load, friction.ball_cage);
        assert!(pushes, "{name}: {pocket:?} at {} s", outputs.time);
    }
    if let Some(cage) = &outputs.cage {
        // Loads on both lands need not have one direction.
        let [one, other] = cage.land_loads;
        let pushes = one >= 0.0 && pushes(&cage.land_force, one + other, friction.cage_race);
        assert!(pushes && other >= 0.0, "{name}: {cage:?} at {} s", outputs.time);
    }
}

/// (d) the next step from here satisfies the equations of the HHT scheme, evaluated afresh from its two states.
pub fn converged(name: &str, simulation: &Simulation) {
    let mut probe = simulation.clone();
    let before = probe.state().clone();
    let end = before.time + before.control.step();
    if end <= before.time || probe.advance(end).is_err() {
        return;
    }
    if probe.state().statistics.steps != before.statistics.steps + 1 {
        return; // divided, so that only its last part could be seen
    }
    let residual = residual(&probe, &before);
    let tolerance = before.force_tolerance * (1.0 + 1e-6);
    assert!(
        residual <= tolerance,
        "{name}: a step from {} s leaves {residual:e} of {tolerance:e} N",
        before.time
    );
}

/// [N] largest residual of `m a1 = (1 - alpha_f) g1 + alpha_f g0` with forces evaluated afresh at the end; every step
/// makes good what the one before left.
fn residual(end: &Simulation, before: &State) -> f64 {
    let (model, state) = (end.model(), end.state());
    let weight = 1.0 - model.solver.alpha_f;
    let conditions = end.conditions();
    let contacts = model.contacts_oriented(&conditions, state.orientations.as_ref());
    let races = Race::BOTH.map(|race| state.race(race).motion());
    let ball = &model.bearing.ball;
    let ambient = model.ambient(&end.inputs().effects.frame.motion);
    let mut worst = 0.0f64;
    let cage = model.cage.as_ref().zip(state.cage());
    let cage_motion = state.cage().map(BodyState::body_motion);
    let mut on_cage = Wrench::default();
    let oil = model.oil_around_cage(&conditions);
    let neighbours = Contacts::new(model, state, &end.conditions());
    for (index, (now, old)) in state.balls.iter().zip(&before.balls).enumerate() {
        // Polynomials are those that the step was solved with.
        let [inner, outer] = Race::BOTH.map(|race| {
            let contact = contacts[race].of_ball(index, state.difference(index, race));
            contact.evaluated(&now.motion(), &races[race as usize])
        });
        let outside = ambient.on_ball(&now.motion());
        let mut force = outside.force + inner.force + outer.force;
        let mut moment = outside.moment + inner.ball_moment + outer.ball_moment;
        let touching = cage
            .zip(cage_motion.as_ref())
            .and_then(|((cage, _), motion)| cage.pocket_contact(index, &now.motion(), motion, oil));
        if let Some(pocket) = touching {
            force += pocket.force;
            moment += pocket.moment;
            on_cage.force -= pocket.force;
            on_cage.moment += pocket.other_moment;
        }
        for push in neighbours.neighbours_on(index) {
            force += push.force;
            moment += push.moment;
        }
        let linear = now.acceleration * ball.mass - force * weight - old.total.force * (1.0 - weight)
            + old.remainder.force;
        let angular =
            now.angular_acceleration * ball.inertia - moment * weight - old.total.moment * (1.0 - weight)
                + old.remainder.moment;
        worst = worst.max(linear.amax()).max(angular.amax() / ball.radius);
    }
    for race in Race::BOTH {
        let (now, old) = (state.race(race), before.race(race));
        if let Some(body) = &model.bodies[race] {
            let linear =
                now.acceleration * body.mass - now.total.force * weight - old.total.force * (1.0 - weight)
                    + old.remainder.force;
            let angular = now.rate_derivative.component_mul(&body.inertia)
                - now.total.moment * weight
                - old.total.moment * (1.0 - weight)
                + old.remainder.moment;
            worst = worst.max(linear.amax()).max(angular.amax() / model.race_length());
        }
    }
    if let (Some((cage, now)), Some(motion), Some(old)) = (cage, &cage_motion, before.cage()) {
        for land in cage.land_contacts(motion, |race| races[race as usize], oil).iter().flatten() {
            on_cage.force += land.force;
            on_cage.moment += land.moment;
        }
        let body = model.bodies.get(Body::Cage).unwrap().as_ref().unwrap();
        let mut force = on_cage.force + ambient.gravity * body.mass;
        let momentum = now.rate.component_mul(&body.inertia);
        let to_body = now.pose.orientation.inverse();
        let mut moment = to_body * on_cage.moment - now.rate.cross(&momentum);
        if let Some(frame) = &ambient.frame {
            force += frame.field(&now.pose.position, &now.velocity) * body.mass;
            moment += frame.moment(&body.inertia, &now.rate, |v| to_body * v);
        }
        let linear = now.acceleration * body.mass - force * weight - old.total.force * (1.0 - weight)
            + old.remainder.force;
        let angular = now.rate_derivative.component_mul(&body.inertia)
            - moment * weight
            - old.total.moment * (1.0 - weight)
            + old.remainder.moment;
        worst = worst.max(linear.amax()).max(angular.amax() / model.race_length());
    }
    worst
}

/// (a) a refusal that names every one of `parts`.
pub fn refuses(name: &str, error: &str, parts: &[&str]) {
    println!("\n| {name} | refused: {error} |");
    figures::compare_refusal(name, error);
    for part in parts {
        assert!(error.contains(part), "{name}: `{error}` does not name {part}");
    }
}
