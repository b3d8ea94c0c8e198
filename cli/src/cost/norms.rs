//! Distance of a run from its reference, in the quantities that a user of a bearing model looks at.

use strum::{EnumCount, IntoStaticStr, VariantArray};

use super::levers::Level;
use super::record::{Record, Sample};

/// A quantity whose error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, IntoStaticStr, VariantArray)]
pub enum Norm {
    /// Wrench of the bearing on the inner race but for the moment about its axis.
    #[strum(serialize = "wrench")]
    Wrench,
    /// Displacement of the inner race; of a race with given motion there is no error to speak of.
    #[strum(serialize = "displacement")]
    Displacement,
    /// Friction torque.
    #[strum(serialize = "friction torque")]
    FrictionTorque,
    /// Mean power lost.
    #[strum(serialize = "mean power")]
    Power,
    /// Orbital speed of every ball.
    #[strum(serialize = "ball orbit")]
    Orbit,
    /// Cage speed.
    #[strum(serialize = "cage speed")]
    CageSpeed,
    /// Energy that the run cannot account for, over the energy that the reference lost.
    #[strum(serialize = "energy balance")]
    Energy,
}

impl Norm {
    /// Name in tables and plots.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Relative errors; none where a quantity is not defined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors([Option<f64>; Norm::COUNT]);

impl Errors {
    /// [-] error of a quantity.
    pub fn get(&self, norm: Norm) -> Option<f64> {
        self.0[norm as usize]
    }

    /// [-] the largest, the energy balance apart: that is a property of the run and not a distance.
    pub fn worst(&self) -> Option<f64> {
        let compared = Norm::VARIANTS.iter().filter(|&&norm| norm != Norm::Energy);
        compared.filter_map(|&norm| self.get(norm)).reduce(f64::max)
    }
}

/// How two runs are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Root mean square over the window of the difference at equal times: for smooth runs.
    Pointwise,
    /// Difference of the means over the window: for runs with impacts, whose trajectories diverge.
    WindowMeans,
}

/// Errors of a run against a reference from `window_start` \[s] on, at the times that both have.
///
/// Differences are over the root mean square of the reference, of a vector as a whole.
pub fn errors(record: &Record, reference: &Record, how: Comparison, window_start: f64) -> Errors {
    let pairs = common(record, reference, window_start);
    let distance = |get: &dyn Fn(&Sample) -> &[f64]| relative_distance(&pairs, get, how);
    let mut errors = Errors::default();
    let mut set = |norm: Norm, error: Option<f64>| errors.0[norm as usize] = error.filter(|e| e.is_finite());
    set(Norm::Wrench, distance(&|s| &s.wrench));
    set(Norm::Displacement, distance(&|s| &s.displacement));
    set(Norm::FrictionTorque, distance(&|s| std::slice::from_ref(&s.friction_torque)));
    set(Norm::Orbit, distance(&|s| &s.orbital_speed));
    set(Norm::CageSpeed, distance(&|s| std::slice::from_ref(&s.cage_speed)));
    let power = mean_power(reference, window_start);
    set(Norm::Power, Some((mean_power(record, window_start) / power - 1.0).abs()));
    if let (Level::Dynamic, [first, .., last], [ref_first, .., ref_last]) =
        (record.level, &record.samples[..], &reference.samples[..])
    {
        let lost = ref_last.dissipated - ref_first.dissipated;
        set(Norm::Energy, Some(((last.unaccounted - first.unaccounted) / lost).abs()));
    }
    errors
}

/// Samples of both runs at equal times in the window.
fn common<'a>(record: &'a Record, reference: &'a Record, from: f64) -> Vec<(&'a Sample, &'a Sample)> {
    /// \[s] times closer than this are equal: communication points differ by rounding alone.
    const SAME_TIME: f64 = 1e-10;
    let mut others = reference.samples.iter().peekable();
    let mut pairs = Vec::new();
    for sample in record.samples.iter().filter(|sample| sample.time >= from - SAME_TIME) {
        while others.next_if(|other| other.time < sample.time - SAME_TIME).is_some() {}
        if let Some(other) = others.next_if(|other| other.time <= sample.time + SAME_TIME) {
            pairs.push((sample, other));
        }
    }
    pairs
}

fn relative_distance(
    pairs: &[(&Sample, &Sample)],
    get: &dyn Fn(&Sample) -> &[f64],
    how: Comparison,
) -> Option<f64> {
    let count = pairs.len() as f64;
    let width = get(pairs.first()?.1).len();
    let size: f64 = pairs.iter().flat_map(|(_, r)| get(r)).map(|x| x * x).sum();
    let difference = |i: usize| pairs.iter().map(move |(s, r)| get(s)[i] - get(r)[i]);
    let square: f64 = match how {
        Comparison::Pointwise => (0..width).flat_map(difference).map(|d| d * d).sum(),
        Comparison::WindowMeans => {
            let mean = |i| difference(i).sum::<f64>() / count;
            (0..width).map(|i| count * mean(i) * mean(i)).sum()
        }
    };
    Some((square / size).sqrt())
}

/// \[W] mean power lost from a time on: by the energy lost, or of an equilibrium by its friction power.
fn mean_power(record: &Record, from: f64) -> f64 {
    let window = record.samples.partition_point(|sample| sample.time < from * (1.0 - 1e-9));
    let window = &record.samples[window..];
    match (record.level, window) {
        (Level::Dynamic, [first, .., last]) => {
            (last.dissipated - first.dissipated) / (last.time - first.time)
        }
        _ => window.iter().map(|sample| sample.friction_power).sum::<f64>() / window.len() as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::meter::Cost;
    use roulement::model::state::Statistics;

    /// A run of 1 s at 100 W whose quantities are `1 + ripple cos(time) + offset`.
    fn run(points: u32, ripple: f64, offset: f64) -> Record {
        let sample = |point: u32| {
            let time = f64::from(point) / f64::from(points);
            let x = 1.0 + ripple * (2.0 * std::f64::consts::PI * time).cos() + offset;
            Sample {
                time,
                wrench: [x, 0.0, 0.0, 0.0, 0.0],
                displacement: [0.0; 5],
                friction_torque: x,
                friction_power: x,
                orbital_speed: vec![x, 2.0 * x],
                cage_speed: 1.5 * x,
                dissipated: 100.0 * time * (1.0 + offset),
                unaccounted: 3.0 * time,
            }
        };
        let samples = (0..=points).map(sample).collect();
        let cost = Cost { cpu: 1.0, instructions: None };
        Record { samples, cost, work: Statistics::default(), level: Level::Dynamic }
    }

    #[test]
    fn closed_form_errors_of_an_offset_and_of_a_ripple() {
        let reference = run(100, 0.0, 0.0);
        let near = |error: Option<f64>, expected: f64| {
            assert!((error.unwrap() - expected).abs() < 1e-3, "{error:?}");
        };
        for how in [Comparison::Pointwise, Comparison::WindowMeans] {
            let offset = errors(&run(100, 0.0, 0.02), &reference, how, 0.25);
            for norm in [Norm::Wrench, Norm::FrictionTorque, Norm::Power, Norm::Orbit, Norm::CageSpeed] {
                near(offset.get(norm), 0.02);
            }
            near(offset.get(Norm::Energy), 0.03);
            near(offset.worst(), 0.02);
            // Nothing to compare with: the displacement of the reference is zero.
            assert_eq!(offset.get(Norm::Displacement), None);
        }
        // A ripple over whole periods is an error at every point and none of the mean.
        let ripple = run(100, 0.1, 0.0);
        near(errors(&ripple, &reference, Comparison::Pointwise, 0.0).get(Norm::Wrench), 0.1 / 2f64.sqrt());
        near(errors(&ripple, &reference, Comparison::WindowMeans, 0.0).get(Norm::Wrench), 0.0);
    }

    #[test]
    fn invariant_only_common_times_are_compared() {
        let reference = run(100, 0.1, 0.0);
        for points in [10, 50, 100, 200, 400] {
            let same = errors(&run(points, 0.1, 0.0), &reference, Comparison::Pointwise, 0.25);
            assert!(same.get(Norm::Wrench).unwrap() < 1e-12);
        }
        assert_eq!(common(&run(7, 0.0, 0.0), &reference, 0.5).len(), 1);
    }
}
