//! Balls that are sought together, in the lanes of a vector, from where they were.
//!
//! It is Newton's method of [`super::ball`] without a line search, the gyroscopic couple evaluated at each place: near to where balls were it needs
//! few evaluations. There is one balance only, so that what it ends at is that; a ball that it does not come to in a few evaluations,
//! or that leaves the inner ring, is sought by itself.

use nalgebra::Vector2;

use super::ball::{Ball, Contacts, Groove, ROUND_OFF_UNITS, Settled, TOLERANCE};
use super::bearing::Rested;
use super::rings::Crossing;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::Scalar;

/// Evaluations, after which a ball is sought by itself: a couple nearly as large as the loads takes longer, as it is followed without its derivative.
const MAX_EVALUATIONS: u32 = 12;

/// Balls and what holds them at a place.
pub struct Found {
    place: [Lanes; 2],
    normals: [[Lanes; 2]; 2],
    distances: [Lanes; 2],
    loads: [Lanes; 2],
    slopes: [Lanes; 2],
    friction: [[Lanes; 2]; 2],
    /// Are they in balance?
    ends: [bool; WIDTH],
}

impl Found {
    /// Balls of a kind, near to where they were.
    pub fn near(kind: &Ball, rested: &[Rested], crossings: &[Crossing; WIDTH]) -> Self {
        // Lanes beyond the last ball do what that does.
        let ball = |lane: usize| &rested[lane.min(rested.len() - 1)];
        let stiffness = [0, 1].map(|k: usize| Lanes::from_fn(|lane| ball(lane).stiffness[k]));
        let c = [0, 1]
            .map(|axis: usize| Lanes::from_fn(|lane| crossings[lane.min(rested.len() - 1)].place[axis]));
        find(kind, stiffness, c, [0, 1].map(|axis: usize| Lanes::from_fn(|lane| ball(lane).place[axis])))
    }

    /// A ball; none if it has to be sought by itself.
    pub fn settled(&self, kind: &Ball, lane: usize) -> Option<Settled> {
        if !self.ends[lane] {
            return None;
        }
        let of = |pair: &[Lanes; 2]| [pair[0].0[lane], pair[1].0[lane]];
        let vector = |pair: &[Lanes; 2]| Vector2::from(of(pair));
        let [distances, loads] = [of(&self.distances), of(&self.loads)];
        let energy = |k: usize| 0.4 * loads[k] * (distances[k] - kind.grooves[k].arc);
        let contacts = Contacts {
            normals: [vector(&self.normals[0]), vector(&self.normals[1])],
            distances,
            loads,
            slopes: of(&self.slopes),
            elastic: energy(0) + energy(1),
        };
        let friction = [vector(&self.friction[0]), vector(&self.friction[1])];
        Some(kind.settled(vector(&self.place), &contacts, friction))
    }
}

/// Newton's method. Compiled twice, as contacts are ([`crate::contact::many`]).
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn find(kind: &Ball, stiffness: [Lanes; 2], c: [Lanes; 2], from: [Lanes; 2]) -> Found {
    // Without a force that holds them on the outer ring, they are known at once.
    let at_rest = kind.centrifugal <= 0.0;
    let [centrifugal, zero] = [kind.centrifugal, 0.0].map(Lanes::constant);
    let mut place = from;
    let mut evaluations = 0;
    loop {
        evaluations += 1;
        let arms = [[place[0] - c[0], place[1] - c[1]], place];
        let distances = arms.map(|[x, r]| (x * x + r * r).sqrt());
        let normals = [0, 1].map(|k: usize| arms[k].map(|of| of / distances[k]));
        let contacts = [0, 1].map(|k: usize| {
            let Groove { arc, .. } = kind.grooves[k];
            let approach = (distances[k] - Lanes::constant(arc)).positive_part();
            let root = approach.sqrt();
            let slope = stiffness[k] * root;
            [slope * approach, slope.scale(1.5)]
        });
        let (loads, slopes) = (contacts.map(|of| of[0]), contacts.map(|of| of[1]));
        let friction = match &kind.couple {
            Some(couple) => kind.carried(couple, &normals, &loads),
            None => [[zero; 2]; 2],
        };
        let outside = [friction[0][0] + friction[1][0], friction[0][1] + friction[1][1] + centrifugal];
        let left = [0, 1]
            .map(|axis: usize| outside[axis] - normals[0][axis] * loads[0] - normals[1][axis] * loads[1]);
        let size = left[0] * left[0] + left[1] * left[1];
        let rounding =
            (slopes[0] * distances[0] + slopes[1] * distances[1]).scale(ROUND_OFF_UNITS * f64::EPSILON);
        let small = (loads[0] + loads[1] + centrifugal).scale(TOLERANCE);
        let pressed: [bool; WIDTH] =
            std::array::from_fn(|lane| loads[0].0[lane] > 0.0 && loads[1].0[lane] > 0.0);
        let ends = std::array::from_fn(|lane| {
            let may_be = small.0[lane].max(rounding.0[lane]);
            !at_rest && pressed[lane] && size.0[lane] <= may_be * may_be
        });
        let goes_on = |lane: usize| pressed[lane] && !ends[lane];
        if at_rest || evaluations == MAX_EVALUATIONS || !(0..WIDTH).any(goes_on) {
            return Found { place, normals, distances, loads, slopes, friction, ends };
        }
        // `n n^T k + (1 - n n^T) Q/d` of both.
        let across = [0, 1].map(|k: usize| loads[k] / distances[k]);
        let more = [0, 1].map(|k: usize| slopes[k] - across[k]);
        let entry = |i: usize, j: usize| {
            normals[0][i] * normals[0][j] * more[0] + normals[1][i] * normals[1][j] * more[1]
        };
        let both = across[0] + across[1];
        let (xx, xr, rr) = (entry(0, 0) + both, entry(0, 1), entry(1, 1) + both);
        let determinant = xx * rr - xr * xr;
        let step = [rr * left[0] - xr * left[1], xx * left[1] - xr * left[0]].map(|of| of / determinant);
        place = [0, 1].map(|axis: usize| {
            Lanes::from_fn(|lane| place[axis].0[lane] + if goes_on(lane) { step[axis].0[lane] } else { 0.0 })
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::ball::Couple;
    use super::*;
    use crate::contact::normal::Damping;

    #[test]
    fn identity_balls_sought_together_are_those_sought_one_by_one() {
        let couples =
            [None, Some(Couple { force: 8.0, friction: 0.1 }), Some(Couple { force: -4.0, friction: 0.05 })];
        let (mut together, mut alone) = (0, 0);
        for couple in couples {
            for case in 0..200 {
                let angle = 0.01 * f64::from(case) - 1.0;
                let size = |lane: usize| 2.0 * 3e-4 + 1.4e-5 * (f64::from(case) + 11.0 * lane as f64).sin();
                let kind = Ball {
                    grooves: [Groove { arc: 2.9e-4, stiffness: 0.0 }, Groove { arc: 3e-4, stiffness: 0.0 }],
                    centrifugal: 40.0,
                    couple,
                    damping: Damping::HuntCrossley(0.1),
                };
                let count = 1 + case as usize % WIDTH;
                let balls: Vec<Ball> = (0..count)
                    .map(|lane| {
                        let mut ball = kind;
                        ball.grooves[0].stiffness = 8e9 * (1.0 + 0.01 * lane as f64);
                        ball.grooves[1].stiffness = 9e9;
                        ball
                    })
                    .collect();
                let c: Vec<_> =
                    (0..count).map(|lane| Vector2::new(angle.sin(), angle.cos()) * size(lane)).collect();
                let zero = [Vector2::zeros(); 2];
                let exact: Vec<_> =
                    balls.iter().zip(&c).map(|(ball, c)| ball.settle(c, &(c * 0.5), &zero)).collect();
                // From a little away.
                let from: Vec<_> = exact.iter().map(|of| of.place + Vector2::new(3e-7, -2e-7)).collect();
                let lanes = |of: &dyn Fn(usize) -> f64| Lanes::from_fn(|lane| of(lane.min(count - 1)));
                let stiffness = [0, 1].map(|k: usize| lanes(&|lane| balls[lane].grooves[k].stiffness));
                let [c, from] = [c, from].map(|of| [0, 1].map(|axis: usize| lanes(&|lane| of[lane][axis])));
                let all = find(&kind, stiffness, c, from);
                for (lane, exact) in exact.iter().enumerate() {
                    let Some(found) = all.settled(&kind, lane) else {
                        alone += 1;
                        // Only what hardly presses the inner ring is left, or has a couple of a quarter of its loads.
                        assert!(exact.loads[0] < 30.0, "{case} {exact:?}");
                        continue;
                    };
                    together += 1;
                    let loads = exact.loads[0] + exact.loads[1];
                    assert!((found.force - exact.force).norm() < 1e-9 * loads, "{case} {found:?} {exact:?}");
                    assert!((found.elastic - exact.elastic).abs() < 1e-9 * exact.elastic, "{case}");
                    assert!((found.damping - exact.damping).abs() < 1e-6 * exact.damping, "{case}");
                    assert!(found.unbalanced < 1e-9 * loads, "{case} {found:?}");
                }
            }
        }
        assert!(together > 900 && alone > 40, "{together} {alone}");
    }
}
