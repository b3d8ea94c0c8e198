//! Intermediate update: inputs that are set within a communication step, after each step of the integrator.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr;

use roulement::fmi::v3::Status;
use roulement::interface::variables::{Causality, Kind};

use crate::fmi2_abi::*;
use crate::fmi3_abi::*;
use crate::scenes::scene;

/// What a master is told, and what it may answer.
#[derive(Clone, Copy, Debug)]
struct Asked {
    time: f64,
    may_return: bool,
}

/// A master: called within steps, it may call the instance, and may ask for the step's end at a time.
struct Master<'a> {
    slave: Slave,
    work: Box<dyn FnMut(Slave, Asked) -> Option<f64> + 'a>,
}

unsafe extern "C" fn update(
    master: *mut c_void,
    time: f64,
    may_set: bool,
    may_get: bool,
    finished: bool,
    may_return: bool,
    requested: *mut bool,
    end: *mut f64,
) {
    assert!(may_set && may_get && finished);
    unsafe {
        let master = &mut *master.cast::<Master<'_>>();
        let answer = (master.work)(master.slave, Asked { time, may_return });
        *requested = answer.is_some();
        if let Some(answer) = answer {
            *end = answer;
        }
    }
}

/// An instance whose callback does some work; it lives as long as what is given back.
fn with_updates<'a>(
    package: &Package,
    work: impl FnMut(Slave, Asked) -> Option<f64> + 'a,
) -> Box<Master<'a>> {
    let mut master = Box::new(Master { slave: Slave(ptr::null_mut()), work: Box::new(work) });
    let environment = ptr::from_mut(&mut *master).cast();
    master.slave = Slave::with(package, environment, None, Some(update)).initialise();
    master
}

fn reals(package: &Package) -> Vec<u32> {
    let rows = package.rows.iter().enumerate();
    rows.filter(|(_, row)| row.kind == Kind::Real).map(|(index, _)| index as u32).collect()
}

#[test]
fn invariant_steps_with_updates_are_those_of_a_master_with_steps_as_short() {
    for drive in ["wrench", "pose"] {
        let package = Package::new("v3-updates", &scene_text(drive));
        let (input, load): (_, fn(f64) -> f64) = match drive {
            "wrench" => (package.reference("inner.applied_force.y"), |time| 50.0 * (1e4 * time).sin()),
            _ => (package.reference("friction"), |time| 0.1 - 20.0 * time),
        };
        let mut times = vec![];
        let master = with_updates(&package, |slave, asked| {
            times.push(asked.time);
            assert_eq!(slave.set(&[input], &[load(asked.time)]), Status::Ok);
            None
        });
        let slave = master.slave;
        slave.run(2, 1e-3);
        let values = slave.get(&reals(&package));
        slave.free();
        drop(master);
        assert!(times.len() > 20 && times.last() == Some(&2e-3), "{} steps", times.len());
        if drive == "wrench" {
            let other = Slave::new(&package).initialise();
            let mut time = 0.0;
            for next in times {
                // Times of steps are what they are to the bit: their sums are not exact.
                assert_eq!(other.step(time, next - time).0, Status::Ok);
                time = other.get(&[time_of(&package)])[0];
                assert!((time - next).abs() <= 1e-15);
                assert_eq!(other.set(&[input], &[load(next)]), Status::Ok);
            }
            for ((reference, value), other) in
                reals(&package).iter().zip(values).zip(other.get(&reals(&package)))
            {
                let row = &package.rows[*reference as usize];
                let close = (value - other).abs() <= 1e-6 * row.nominal.max(value.abs());
                assert!(close, "{}: {value} {other}", row.name);
            }
            other.free();
        }
    }
}

#[test]
fn invariant_a_callback_that_sets_nothing_lets_a_race_go_on() {
    let package = Package::new("v3-silent", &pose_text("shaft"));
    let [place, velocity] = ["inner.position.y", "inner.velocity.y"].map(|name| package.reference(name));
    let force = package.reference("inner.force.y");
    let mut asked = 0;
    let master = with_updates(&package, |_, _| {
        asked += 1;
        None
    });
    let both = [master.slave, Slave::new(&package).initialise()];
    for slave in both {
        // [m/s] so slow that the path of one step and those of many pieces are nearly the same.
        assert_eq!(slave.set(&[velocity], &[1e-3]), Status::Ok);
        assert_eq!(slave.step(0.0, 1e-3).0, Status::Ok);
    }
    let forces = both.map(|slave| slave.get(&[force])[0]);
    assert!((forces[0] - forces[1]).abs() < 0.02 * forces[1].abs() && forces[1].abs() > 10.0, "{forces:?}");
    // It has gone as far as it was announced to.
    let [there, _] = both.map(|slave| slave.get(&[place])[0]);
    assert!((there - 1e-6).abs() < 1e-8, "{there}");
    both.into_iter().for_each(Slave::free);
    drop(master);
    assert!(asked > 10, "{asked}");
}

/// [kg] the lightest shaft of docs/coupling.md.
const SHAFT: f64 = 1.0;
/// [N] load across the axis.
const LOAD: f64 = 200.0;
/// \[s] communication step.
const STEP: f64 = 1e-3;

/// A shaft that moves along y by semi-implicit Euler: place, velocity, time.
#[derive(Clone, Copy, Default)]
struct Shaft {
    place: f64,
    velocity: f64,
    time: f64,
}

impl Shaft {
    fn go_to(&mut self, time: f64, force: f64) {
        let step = time - self.time;
        self.place += self.velocity * step;
        self.velocity += (force + LOAD) / SHAFT * step;
        self.time = time;
    }
}

#[test]
fn a_shaft_of_one_kilogram_is_stable_at_steps_of_a_millisecond() {
    let text = scene(&pose_text("shaft"), &[("solver.max_step", "\"5 us\"")]).source;
    let package = Package::new("v3-shaft-1kg", &text);
    let names = ["inner.position.y", "inner.velocity.y", "inner.force.y"];
    let [place, velocity, force] = names.map(|name| package.reference(name));
    let follow = |shaft: &mut Shaft, slave: Slave, time: f64| {
        shaft.go_to(time, slave.get(&[force])[0]);
        assert_eq!(slave.set(&[place, velocity], &[shaft.place, shaft.velocity]), Status::Ok);
    };
    // Within steps of a millisecond, and between steps of five microseconds.
    let mut inside = vec![];
    let mut shaft = Shaft::default();
    let mut largest: f64 = 0.0;
    let master = with_updates(&package, |slave, asked| {
        follow(&mut shaft, slave, asked.time);
        inside.push(shaft.place);
        largest = largest.max(shaft.place.abs());
        None
    });
    master.slave.run(20, STEP);
    master.slave.free();
    drop(master);
    let slave = Slave::new(&package).initialise();
    let (mut shaft, mut outside, mut highest) = (Shaft::default(), 0.0, 0.0_f64);
    for k in 0..4000 {
        assert_eq!(slave.step(f64::from(k) * 5e-6, 5e-6).0, Status::Ok);
        follow(&mut shaft, slave, f64::from(k + 1) * 5e-6);
        outside = shaft.place;
        highest = highest.max(outside.abs());
    }
    slave.free();
    let reached = inside[inside.len() - 1];
    println!("steps {}, largest {largest:e} {highest:e} m, last {reached:e} {outside:e} m", inside.len());
    assert!(largest > 1e-7 && (largest - highest).abs() < 0.02 * highest);
    assert!((reached - outside).abs() < 0.02 * highest);
    // Between steps of a millisecond it is lost.
    let slave = Slave::new(&package).initialise();
    let mut shaft = Shaft::default();
    let lost = (0..20).any(|k| {
        let stepped = slave.step(f64::from(k) * STEP, STEP).0;
        if stepped == Status::Ok {
            shaft.go_to(f64::from(k + 1) * STEP, slave.get(&[force])[0]);
            slave.set(&[place, velocity], &[shaft.place, shaft.velocity]);
        }
        stepped != Status::Ok || shaft.place.abs() > 20.0 * highest
    });
    assert!(lost, "{}", shaft.place);
    slave.free();
}

#[test]
fn a_step_ends_early_where_the_master_asks() {
    let package = Package::new("v3-early", &scene_text("wrench"));
    let mut asked = vec![];
    let master = with_updates(&package, |_, one| {
        asked.push(one);
        // Once at once, later at a time between steps of the integrator.
        match asked.len() {
            3 => Some(one.time),
            10 => Some(one.time + 1.5e-7),
            _ => None,
        }
    });
    let slave = master.slave;
    let (status, said) = slave.step(0.0, 1e-3);
    assert_eq!((status, said.early, said.event, said.end), (Status::Ok, true, false, false));
    let third = said.reached;
    assert_eq!(slave.get(&[time_of(&package)]), [third]);
    let (status, said) = slave.step(third, 1e-3);
    assert!(status == Status::Ok && said.early && said.reached > third);
    let (last, again) = (said.reached, slave.step(said.reached, 1e-4));
    assert_eq!((again.0, again.1.early), (Status::Ok, false));
    slave.free();
    drop(master);
    assert_eq!(asked[2].time, third);
    assert_eq!(asked[9].time + 1.5e-7, last);
    assert!(asked[..3].iter().all(|one| one.may_return) && !asked[asked.len() - 1].may_return);
}

#[test]
fn invariant_a_step_with_updates_is_discarded_whole() {
    let steps =
        [("solver.initial_step", "\"10 us\""), ("solver.min_step", "\"8 us\""), ("solver.tolerance", "1e-3")];
    let package = Package::new("v3-updates-discard", &scene(&scene_text("wrench"), &steps).source);
    let force = package.reference("inner.applied_force.x");
    let (bad, calls) = (Cell::new(false), Cell::new(0));
    let master = with_updates(&package, |slave, _| {
        calls.set(calls.get() + 1);
        if bad.get() {
            assert_eq!(slave.set(&[force], &[1e8]), Status::Ok);
        }
        None
    });
    let slave = master.slave.run(2, 1e-4);
    let before = slave.state_bytes();
    bad.set(true);
    let (status, said) = slave.step(2e-4, 1e-2);
    assert_eq!((status, said.early, said.reached), (Status::Discard, false, 2e-4));
    assert_eq!(slave.state_bytes(), before);
    bad.set(false);
    assert_eq!(slave.step(2e-4, 1e-4).0, Status::Ok);
    slave.free();
    drop(master);
    assert!(calls.get() > 10);
}

#[test]
fn within_a_step_only_values_are_read_and_set() {
    let package = Package::new("v3-within", &scene_text("wrench"));
    let parameter = package.references(Causality::Parameter)[0];
    let mut told = false;
    let master = with_updates(&package, |slave, asked| {
        let c = slave.0;
        unsafe {
            assert_eq!(slave.step(asked.time, 1e-5).0, Status::Error);
            assert_eq!(fmi3Terminate(c), Status::Error);
            assert_eq!(fmi3Reset(c), Status::Error);
            assert_eq!(fmi3GetFMUState(c, &mut ptr::null_mut()), Status::Error);
            assert_eq!(fmi3EnterEventMode(c), Status::Error);
        }
        assert_eq!(slave.set(&[parameter], &slave.get(&[parameter])), Status::Error);
        assert_eq!(slave.get(&[time_of(&package)]), [asked.time]);
        assert!(slave.get(&reals(&package)).iter().all(|value| value.is_finite()));
        told = true;
        None
    });
    assert_eq!(master.slave.step(0.0, 1e-4).0, Status::Ok);
    master.slave.free();
    drop(master);
    assert!(told);
}
