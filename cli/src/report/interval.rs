//! Confidence interval of a mean over a window, from the means of groups (batch means).
//!
//! Neighbouring values of a history depend on each other, means of long groups hardly do: the scatter of the group means, with
//! Student's t, gives the interval. How long is long enough depends on the run; of a few divisions of the window the one with
//! the widest interval is taken.

/// Numbers of groups, and Student's t, two-sided 95 %, for one degree of freedom less (Abramowitz and Stegun, table 26.10).
const DIVISIONS: [(usize, f64); 3] = [(8, 2.365), (16, 2.131), (32, 2.040)];

/// Half of the interval at 95 %, from the means of at most so many equal groups; none where there are too few rows.
pub fn of_mean(groups: impl Fn(usize) -> Vec<f64>) -> Option<f64> {
    let of_division = |(most, t): (usize, f64)| {
        let groups = groups(most);
        // Fewer groups are those of a division before.
        (groups.len() == most).then(|| t * standard_error(&groups))
    };
    DIVISIONS.into_iter().filter_map(of_division).reduce(f64::max)
}

fn standard_error(groups: &[f64]) -> f64 {
    let count = groups.len() as f64;
    let mean = groups.iter().sum::<f64>() / count;
    let squares: f64 = groups.iter().map(|group| (group - mean) * (group - mean)).sum();
    (squares / (count - 1.0) / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sequence of numbers in (-1, 1) that look random, each in part the last one's.
    fn noise(count: usize, memory: f64, seed: u64) -> Vec<f64> {
        let (mut state, mut value) = (seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1, 0.0);
        let mut next = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            value = memory * value
                + (1.0 - memory * memory).sqrt() * (state as f64 / u64::MAX as f64 * 2.0 - 1.0);
            value
        };
        (0..count + 1000).map(|_| next()).skip(1000).collect()
    }

    #[test]
    fn closed_form_intervals_hold_the_mean_as_often_as_they_say() {
        // The true mean is 0. Without memory all divisions are right and the widest of them is on the safe side; with a memory
        // of 20 values in 4096 the short groups depend on each other, and the widest still holds it.
        for (memory, least) in [(0.0, 0.95), (0.9, 0.94), (0.95, 0.93)] {
            let held = (1..=400).filter(|&seed| {
                let values = noise(4096, memory, seed);
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                let group = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
                let interval = of_mean(|n| values.chunks_exact(values.len() / n).map(group).collect());
                interval.is_some_and(|interval| mean.abs() <= interval)
            });
            let share = held.count() as f64 / 400.0;
            assert!(share >= least, "{memory}: {share}");
        }
    }

    #[test]
    fn too_few_groups_have_no_interval() {
        assert_eq!(of_mean(|n| vec![1.0; n.min(7)]), None);
        assert_eq!(of_mean(|n| vec![1.0; n.min(9)]), Some(0.0));
    }
}
