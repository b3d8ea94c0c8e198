//! Warnings to whoever runs a machine, while it runs: a pressure that marks the races, a race that moves by more than its loads
//! explain, a motion that grows. Each is told once of each bearing, when it happens.

use super::Simulation;
use super::circling::{Circling, Exciting, Place, Unexplained};
use super::driven::Parts;
use super::system::{ShaftInputs, System, script_changes_within};
use crate::model::bodies::Race;
use crate::scene::Level;

/// \[rad] turn of a race over which its motion is judged.
const WINDOW: f64 = 2.0 * std::f64::consts::TAU;
/// [-] places in a window: fewer do not show how a race moves, and beyond the second number every other one is dropped.
const PLACES: [usize; 2] = [24, 256];
/// [-] growth of what loads do not explain from one window to the next, and windows in a row that grow so.
const GROWS: f64 = 1.3;
const IN_A_ROW: u32 = 4;
/// [-] of the largest force in all directions: a motion of less is not told of while it grows.
const SEEN: f64 = 0.05;

/// A warning of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Alarm {
    /// \[s] when it happened.
    pub time: f64,
    /// Description in a sentence.
    pub sentence: String,
}

impl Alarm {
    /// With its time, after the name of the bearing where that is not alone.
    pub fn text(&self, bearing: &str) -> String {
        let before = if bearing.is_empty() { String::new() } else { format!("bearing {bearing}: ") };
        format!("{before}at {:.3} ms {}", self.time * 1e3, self.sentence)
    }
}

/// Watches one bearing, alone or of a machine.
#[derive(Clone, Debug, Default)]
pub struct BearingAlarms {
    pressed: bool,
    moved: bool,
    grown: bool,
    /// Where the race was since the window began.
    places: Vec<Place>,
    /// Every so many-th place is kept; how many were not since the last one.
    stride: u32,
    skipped: u32,
    /// \[rad] turn since the window began.
    turned: f64,
    /// Was the last window beyond what loads explain?
    was_beyond: bool,
    /// \[N] what loads did not explain in it, and windows in a row in which that grew.
    before: f64,
    growing: u32,
}

impl BearingAlarms {
    /// Takes a largest contact pressure \[Pa].
    pub fn press(&mut self, bearing: &Simulation, pressure: f64) -> Option<Alarm> {
        if self.pressed || bearing.scene().pressure_note(pressure).is_none() {
            return None;
        }
        self.pressed = true;
        let sentence = format!(
            "the contact pressure is {:.0} MPa, above 4200 MPa: balls leave lasting marks",
            pressure * 1e-6
        );
        Some(Alarm { time: bearing.time(), sentence })
    }

    /// Takes where a bearing is, later than before; what changes within a span \[s] of time tells `changes`.
    pub fn step(
        &mut self,
        bearing: &Simulation,
        changes: &dyn Fn(f64, f64) -> bool,
        exciting: Exciting,
    ) -> Option<Alarm> {
        if self.moved && self.grown || bearing.scene().solver.level == Level::Equilibrium {
            return None;
        }
        let time = bearing.time();
        match self.places.last() {
            // An importer went back.
            Some(last) if time <= last.time => self.begin(),
            Some(last) => {
                let spin =
                    bearing.state().race(Race::Inner).rate.x - bearing.state().race(Race::Outer).rate.x;
                // Turn since the last place that was kept.
                let turned = spin.abs() * (time - last.time);
                if self.skipped + 1 < self.stride && self.turned + turned < WINDOW {
                    self.skipped += 1;
                    return None;
                }
                self.turned += turned;
            }
            None => {}
        }
        self.skipped = 0;
        self.places.push(Place::of(bearing)?);
        if self.turned < WINDOW {
            if self.places.len() == PLACES[1] {
                let mut even = false;
                self.places.retain(|_| {
                    even = !even;
                    even
                });
                self.stride = 2 * self.stride.max(1);
            }
            return None;
        }
        let mut places = std::mem::take(&mut self.places);
        self.begin();
        if places.len() < PLACES[0] {
            return None;
        }
        let exciting = Exciting { scripted: changes(places[0].time, time), ..exciting };
        let circling = Circling::of(places.clone(), bearing, exciting);
        let unexplained = Unexplained::of(&mut places, bearing, exciting)?;
        let told = self.judge(unexplained, circling.as_ref());
        told.map(|sentence| Alarm { time, sentence })
    }

    /// Begins a window.
    fn begin(&mut self) {
        (self.stride, self.skipped, self.turned) = (1, 0, 0.0);
        self.places.clear();
    }

    /// Warning of a window, if there is one.
    fn judge(&mut self, unexplained: Unexplained, circling: Option<&Circling>) -> Option<String> {
        let Unexplained { force, largest, .. } = unexplained;
        self.growing = if force > GROWS * self.before && self.before > 0.0 { self.growing + 1 } else { 0 };
        let first = std::mem::replace(&mut self.before, force);
        // A blow is beyond in one window, a motion that stays in the next, too.
        let beyond = std::mem::replace(&mut self.was_beyond, circling.is_some());
        if let Some(circling) = circling.filter(|_| beyond && !self.moved) {
            self.moved = true;
            return Some(circling.motion());
        }
        (self.growing >= IN_A_ROW && force > SEEN * largest && !self.grown && !self.moved).then(|| {
            self.grown = true;
            format!(
                "a motion across the axis grows: what swings of the force grew from {first:.1} to {force:.1} N over the last two turns"
            )
        })
    }
}

/// Watches all bearings of a machine from outside, at the times that an importer stops at.
#[derive(Clone, Debug, Default)]
pub struct Alarms {
    bearings: Vec<BearingAlarms>,
    /// Loads and drive that were set last: windows begin anew where they change.
    inputs: Option<ShaftInputs>,
    /// [-] steps of the integrator when pressures were looked at.
    steps: u64,
}

/// [-] steps of the integrator after which pressures are looked at again: contacts take as long to evaluate as a step.
const STEPS: u64 = 32;

impl Alarms {
    /// Warnings at the present time of a machine, with the names of bearings.
    pub fn step(&mut self, machine: &impl Parts) -> Vec<String> {
        self.bearings.resize_with(machine.bearings().count(), BearingAlarms::default);
        let steps = machine.bearings().next().map_or(0, |(_, bearing)| bearing.state().statistics.steps);
        let looks = steps < self.steps || steps >= self.steps + STEPS;
        if looks {
            self.steps = steps;
        }
        let scene = machine.shaft().map(System::scene);
        let exciting = scene.map_or(Exciting::default(), Exciting::of);
        let inputs = machine.shaft().map(System::inputs);
        if inputs != self.inputs.as_ref() {
            self.inputs = inputs.cloned();
            self.bearings.iter_mut().for_each(BearingAlarms::begin);
        }
        let mut told = vec![];
        for ((name, bearing), alarms) in machine.bearings().zip(&mut self.bearings) {
            let changes = |from, to| {
                bearing.script_changes_within(from, to)
                    || scene.is_some_and(|scene| script_changes_within(scene, from, to))
            };
            let pressed = looks.then(|| bearing.instant().peak_pressure.into_iter().fold(0.0, f64::max));
            let pressed = pressed.and_then(|pressure| alarms.press(bearing, pressure));
            let moved = alarms.step(bearing, &changes, exciting);
            told.extend(pressed.into_iter().chain(moved).map(|alarm| alarm.text(name)));
        }
        told
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Warnings of windows with these forces \[N] that loads do not explain.
    fn told(forces: &[f64]) -> Vec<Option<String>> {
        let mut alarms = BearingAlarms::default();
        let judged = forces
            .iter()
            .map(|force| alarms.judge(Unexplained { force: *force, applied: 1000.0, largest: 1000.0 }, None));
        judged.collect()
    }

    #[test]
    fn closed_form_a_motion_is_said_to_grow_after_four_windows_of_growth_and_once() {
        let grows = told(&[10.0, 20.0, 40.0, 80.0, 160.0, 320.0]);
        assert!(grows[..4].iter().all(Option::is_none) && grows[5].is_none(), "{grows:?}");
        assert!(grows[4].as_deref().unwrap().contains("grew from 80.0 to 160.0 N"), "{grows:?}");
        // Neither a motion that stays, nor one that grows too little or by fits, nor one that is small beside the load.
        for forces in
            [[100.0; 6], [100.0, 120.0, 144.0, 173.0, 207.0, 249.0], [50.0, 100.0, 90.0, 180.0, 170.0, 340.0]]
        {
            assert!(told(&forces).iter().all(Option::is_none), "{forces:?}");
        }
        assert!(told(&[0.5, 1.0, 2.0, 4.0, 8.0, 16.0]).iter().all(Option::is_none));
    }
}
