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
    /// Mean friction power of the contacts with the inner race; as the next one over the power of ALL contacts of the
    /// reference, so that a race that loses next to nothing has a small error.
    #[strum(serialize = "inner race power")]
    InnerPower,
    /// Mean friction power of the contacts with the outer race, over the power of all contacts.
    #[strum(serialize = "outer race power")]
    OuterPower,
    /// Share of the friction power that spin moments lose, over the window: the difference of the shares, which is over nothing.
    #[strum(serialize = "spin share")]
    SpinShare,
    /// Largest load of a contact with a race.
    #[strum(serialize = "largest load")]
    LargestLoad,
    /// Largest peak pressure of a contact with a race.
    #[strum(serialize = "peak pressure")]
    PeakPressure,
}

impl Norm {
    /// Name in tables and plots.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Is it one of single contacts? Goals promise nothing of these; they are there to tell models apart.
    pub fn is_of_contacts(self) -> bool {
        matches!(
            self,
            Self::InnerPower | Self::OuterPower | Self::SpinShare | Self::LargestLoad | Self::PeakPressure
        )
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

    /// [-] the largest, without those of single contacts, of which goals promise nothing. The energy balance is apart: it is a
    /// property of the run and not a distance.
    pub fn worst(&self) -> Option<f64> {
        let compared = Norm::VARIANTS.iter().filter(|&&norm| norm != Norm::Energy && !norm.is_of_contacts());
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

/// Errors of a run against a reference from `window_start` \[s] on, at the times that both have; of several bearings, the largest.
///
/// Differences are over the root mean square of the reference, of a vector as a whole; powers of the races are over that of all
/// contacts, and shares over nothing.
pub fn errors(record: &Record, reference: &Record, how: Comparison, window_start: f64) -> Errors {
    let bearings = record.bearings.iter().zip(&reference.bearings);
    let of_bearing = |(samples, reference): (&Vec<Sample>, &Vec<Sample>)| {
        of(record.level, samples, reference, how, window_start)
    };
    let larger = |all: Errors, one: Errors| {
        let most = |i: usize| all.0[i].into_iter().chain(one.0[i]).reduce(f64::max);
        Errors(std::array::from_fn(most))
    };
    bearings.map(of_bearing).reduce(larger).unwrap_or_default()
}

/// Errors of a bearing.
fn of(level: Level, run: &[Sample], reference: &[Sample], how: Comparison, window_start: f64) -> Errors {
    let pairs = common(run, reference, window_start);
    let distance = |get: &dyn Fn(&Sample) -> &[f64]| relative_distance(&pairs, get, how);
    let mut errors = Errors::default();
    let mut set = |norm: Norm, error: Option<f64>| errors.0[norm as usize] = error.filter(|e| e.is_finite());
    set(Norm::Wrench, distance(&|s| &s.wrench));
    set(Norm::Displacement, distance(&|s| &s.displacement));
    set(Norm::FrictionTorque, distance(&|s| std::slice::from_ref(&s.friction_torque)));
    set(Norm::Orbit, distance(&|s| &s.orbital_speed));
    set(Norm::CageSpeed, distance(&|s| std::slice::from_ref(&s.cage_speed)));
    set(Norm::LargestLoad, distance(&|s| std::slice::from_ref(&s.largest_load)));
    set(Norm::PeakPressure, distance(&|s| std::slice::from_ref(&s.peak_pressure)));
    let sums = |get: &dyn Fn(&Sample) -> f64| {
        pairs.iter().fold([0.0, 0.0], |[run, of], (sample, other)| [run + get(sample), of + get(other)])
    };
    let all = sums(&|s| s.friction_power);
    for (norm, race) in [(Norm::InnerPower, 0), (Norm::OuterPower, 1)] {
        let [own, of] = sums(&|s| s.race_power[race]);
        set(norm, Some(((own - of) / all[1]).abs()));
    }
    let [own, of] = sums(&|s| s.spin_power);
    set(Norm::SpinShare, Some((own / all[0] - of / all[1]).abs()));
    // References are integrated in time.
    let power = mean_power(Level::Dynamic, reference, window_start);
    set(Norm::Power, Some((mean_power(level, run, window_start) / power - 1.0).abs()));
    if let (Level::Dynamic, [first, .., last], [ref_first, .., ref_last]) = (level, run, reference) {
        let lost = ref_last.dissipated - ref_first.dissipated;
        set(Norm::Energy, Some(((last.unaccounted - first.unaccounted) / lost).abs()));
    }
    errors
}

/// Samples of both runs at equal times in the window.
fn common<'a>(run: &'a [Sample], reference: &'a [Sample], from: f64) -> Vec<(&'a Sample, &'a Sample)> {
    /// \[s] times closer than this are equal: communication points differ by rounding alone.
    const SAME_TIME: f64 = 1e-10;
    let mut others = reference.iter().peekable();
    let mut pairs = Vec::new();
    for sample in run.iter().filter(|sample| sample.time >= from - SAME_TIME) {
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
fn mean_power(level: Level, samples: &[Sample], from: f64) -> f64 {
    let window = samples.partition_point(|sample| sample.time < from * (1.0 - 1e-9));
    let window = &samples[window..];
    match (level, window) {
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

    /// [-] a change of the outer races' power over that of all else, in [`run`].
    const SHIFTED: f64 = 10.0;

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
                race_power: [0.7 * x, 0.01 * (1.0 + SHIFTED * offset)],
                spin_power: 0.6,
                largest_load: 900.0 * x,
                peak_pressure: 2e9 * x,
                orbital_speed: vec![x, 2.0 * x],
                cage_speed: 1.5 * x,
                dissipated: 100.0 * time * (1.0 + offset),
                unaccounted: 3.0 * time,
            }
        };
        let samples = (0..=points).map(sample).collect();
        let cost = Cost { cpu: 1.0, instructions: None };
        Record {
            bearings: vec![samples],
            cost,
            work: Statistics::default(),
            level: Level::Dynamic,
            means: vec![],
        }
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
            // Of the whole power: 0.7 of it is 2 % off, and 0.01 of it 20 %.
            near(offset.get(Norm::InnerPower), 0.7 * 0.02);
            assert!((offset.get(Norm::OuterPower).unwrap() - 0.002).abs() < 1e-9);
            // The same spin power in 2 % more of all.
            let share = offset.get(Norm::SpinShare).unwrap();
            assert!((share - (0.6 - 0.6 / 1.02)).abs() < 1e-9, "{share}");
            near(offset.get(Norm::LargestLoad), 0.02);
            near(offset.get(Norm::PeakPressure), 0.02);
            // Nothing to compare with: the displacement of the reference is zero.
            assert_eq!(offset.get(Norm::Displacement), None);
        }
        // A ripple over whole periods is an error at every point and none of the mean.
        let ripple = run(100, 0.1, 0.0);
        near(errors(&ripple, &reference, Comparison::Pointwise, 0.0).get(Norm::Wrench), 0.1 / 2f64.sqrt());
        near(errors(&ripple, &reference, Comparison::WindowMeans, 0.0).get(Norm::Wrench), 0.0);
        // Powers of the races are means however runs are compared; loads and pressures are not.
        let ripple = errors(&ripple, &reference, Comparison::Pointwise, 0.0);
        near(ripple.get(Norm::InnerPower), 0.0);
        near(ripple.get(Norm::LargestLoad), 0.1 / 2f64.sqrt());
    }

    #[test]
    fn invariant_quantities_of_contacts_are_in_no_promise() {
        let reference = run(100, 0.0, 0.0);
        let mut other = reference.clone();
        for sample in &mut other.bearings[0] {
            // The races exchange their powers, half of the spin is gone, and one ball carries it all.
            sample.race_power.swap(0, 1);
            (sample.spin_power, sample.largest_load, sample.peak_pressure) = (0.3, 5e3, 4e9);
        }
        let errors = errors(&other, &reference, Comparison::Pointwise, 0.25);
        let contacts = Norm::VARIANTS.iter().filter(|norm| norm.is_of_contacts());
        for &norm in contacts {
            assert!(errors.get(norm).unwrap() > 0.2, "{}", norm.name());
        }
        assert_eq!(errors.worst(), Some(0.0));
        // Without friction there is no share of it.
        for sample in &mut other.bearings[0] {
            (sample.race_power, sample.spin_power, sample.friction_power) = ([0.0; 2], 0.0, 0.0);
        }
        let none = super::errors(&other, &reference, Comparison::Pointwise, 0.25);
        assert_eq!((none.get(Norm::SpinShare), none.get(Norm::InnerPower).is_some()), (None, true));
    }

    #[test]
    fn invariant_only_common_times_are_compared() {
        let reference = run(100, 0.1, 0.0);
        for points in [10, 50, 100, 200, 400] {
            let same = errors(&run(points, 0.1, 0.0), &reference, Comparison::Pointwise, 0.25);
            assert!(same.get(Norm::Wrench).unwrap() < 1e-12);
        }
        assert_eq!(common(&run(7, 0.0, 0.0).bearings[0], &reference.bearings[0], 0.5).len(), 1);
    }
}
