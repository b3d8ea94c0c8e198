//! Motion of the centre of a cage, and its kind.
//!
//! Schwarz, Grillenberger and Tremmel (2020) sort motions of cages into unstable, stable and circling, by an indicator of their own and limits
//! fitted to thousands of simulations. The kinds here are theirs, told by three ratios without anything fitted: how far the centre goes
//! from the middle of its way, how round its way is, and how fast it moves beside the cage's turn.

use std::f64::consts::TAU;

use nalgebra::Vector2;

/// [-] of its play: a cage whose centre stays within this of the middle of its way touches one side at most, and gets no blows from the
/// other.
const STILL: f64 = 0.1;
/// [-] how round a way is from which on it is a whirl, where 1 is a circle: half way between a circle and to and fro.
const ROUND: f64 = 0.5;
/// Points of a figure at most.
const POINTS: usize = 4000;

/// A cage where a step has ended.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// \[s] time.
    pub time: f64,
    /// \[m] its centre, across the axis of the race that guides it.
    pub centre: Vector2<f64>,
    /// \[rad] turned about its own axis.
    pub turned: f64,
    /// \[N] largest load in a pocket.
    pub pocket_load: f64,
    /// \[N] largest load on a land.
    pub land_load: f64,
    /// \[W] friction power in all its contacts.
    pub power: f64,
    /// \[W] all losses of the bearing.
    pub losses: f64,
}

/// Kinds of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The centre stays about where it is, or nothing touches the cage.
    Stable,
    /// The centre goes round.
    Whirls,
    /// The centre goes to and fro.
    Rattles,
}

impl Kind {
    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Whirls => "whirls",
            Self::Rattles => "rattles",
        }
    }
}

/// Motion of the centre of a cage over a time.
#[derive(Clone, Debug)]
pub struct Orbit {
    /// Kind of motion.
    pub kind: Kind,
    /// [-] largest distance of the centre from the middle of its way, over the play.
    pub reach: f64,
    /// [-] largest distance from the axis of the guide, over the play.
    pub eccentricity: f64,
    /// [-] how round the way is: 1 with the cage's turn in a circle, -1 against it, 0 to and fro.
    pub round: f64,
    /// [-] speed of the whirl over that of the cage's turn, by areas swept about the middle of the way; none where the cage does not turn or
    /// its centre does not move.
    pub whirl_ratio: Option<f64>,
    /// [-] mean speed of the centre over play times speed of turn: 1 for a circle of the whole play once a turn, more where the motion is
    /// faster than the turn; none where the cage does not turn.
    pub speed_ratio: Option<f64>,
    /// [-] turns of the cage in this time.
    pub turns: f64,
    /// \[N] largest load in a pocket.
    pub pocket_load: f64,
    /// \[N] largest load on a land.
    pub land_load: f64,
    /// \[W] mean friction power of the cage's contacts.
    pub power: f64,
    /// [-] that over all losses of the bearing; none where nothing is lost.
    pub share: Option<f64>,
    /// [-] its way over the play, at some of the steps.
    pub way: Vec<[f64; 2]>,
}

impl Orbit {
    /// The motion through some places of a cage with this play \[m]; none of fewer than three.
    pub fn of(places: &[Place], play: f64) -> Option<Self> {
        let [first, _, .., last] = places else { return None };
        // Means over time, by the trapezoidal rule.
        let mean = |of: &dyn Fn(&Place) -> f64| {
            let parts = places.windows(2).map(|two| {
                let [one, next] = two else { return 0.0 };
                0.5 * (of(one) + of(next)) * (next.time - one.time)
            });
            parts.sum::<f64>() / (last.time - first.time)
        };
        let most = |of: &dyn Fn(&Place) -> f64| places.iter().map(of).fold(0.0, f64::max);
        // From the first place on, so that one that stays has no way by rounding.
        let from = |place: &Place| place.centre - first.centre;
        let middle = first.centre + Vector2::new(mean(&|place| from(place).x), mean(&|place| from(place).y));
        // What is swept about the middle: twice the area, the most that a circle would sweep with this way, and radius squared over time.
        let (mut swept, mut most_swept, mut squares, mut length) = (0.0, 0.0, 0.0, 0.0);
        for two in places.windows(2) {
            let [one, next] = two else { continue };
            let (way, radius) = (next.centre - one.centre, 0.5 * (one.centre + next.centre) - middle);
            swept += radius.perp(&way);
            most_swept += radius.norm() * way.norm();
            squares += radius.norm_squared() * (next.time - one.time);
            length += way.norm();
        }
        let angle = last.turned - first.turned;
        let time = last.time - first.time;
        let turns = angle.abs() / TAU;
        let reach = most(&|place| (place.centre - middle).norm()) / play;
        let round = if most_swept > 0.0 { swept / most_swept * angle.signum() } else { 0.0 };
        let (pocket_load, land_load) = (most(&|place| place.pocket_load), most(&|place| place.land_load));
        // What nothing touches drifts through its play by itself.
        let touched = pocket_load > 0.0 || land_load > 0.0;
        let kind = match (reach < STILL || !touched, round.abs() > ROUND) {
            (true, _) => Kind::Stable,
            (false, true) => Kind::Whirls,
            (false, false) => Kind::Rattles,
        };
        let (power, losses) = (mean(&|place| place.power), mean(&|place| place.losses));
        let every = places.len().div_ceil(POINTS);
        let way = places.iter().step_by(every).map(|place| (place.centre / play).into()).collect();
        Some(Self {
            kind,
            reach,
            eccentricity: most(&|place| place.centre.norm()) / play,
            round,
            whirl_ratio: (angle != 0.0 && squares > 0.0).then(|| swept / squares / (angle / time)),
            speed_ratio: (angle != 0.0).then(|| length / (play * angle.abs())),
            turns,
            pocket_load,
            land_load,
            power,
            share: (losses > 0.0).then_some(power / losses),
            way,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// A cage that turns at 100 rad/s for 0.2 s, its centre moved by a rule.
    fn moved(centre: impl Fn(f64) -> Vector2<f64>) -> Orbit {
        let place = |step: i32| {
            let time = 1e-5 * f64::from(step);
            let (pocket_load, land_load, power, losses) = (1.0, 2.0, 3.0, 12.0);
            Place { time, centre: centre(time), turned: 100.0 * time, pocket_load, land_load, power, losses }
        };
        Orbit::of(&(0..=20_000).map(place).collect::<Vec<_>>(), 1e-4).unwrap()
    }

    #[test]
    fn closed_form_circles_lines_and_rest() {
        // A circle of half the play about a place off the axis, at 0.4 of the cage's speed; 20 rad/s against it.
        for (speed, ratio) in [(40.0, 0.4), (-20.0, -0.2)] {
            let circle = |t: f64| Vector2::new(3e-5 + 5e-5 * (speed * t).cos(), 5e-5 * (speed * t).sin());
            let orbit = moved(circle);
            assert_eq!(orbit.kind, Kind::Whirls);
            // The middle is that of whole rounds and parts of them.
            assert!((orbit.whirl_ratio.unwrap() / ratio - 1.0).abs() < 0.1, "{orbit:?}");
            assert!((orbit.speed_ratio.unwrap() / (0.5 * ratio.abs()) - 1.0).abs() < 1e-6);
            assert!(orbit.round * ratio.signum() > 0.9);
        }
        // To and fro at ten times its speed.
        let line = moved(|t| Vector2::new(9e-5 * (1000.0 * t).sin(), 0.0));
        assert_eq!(line.kind, Kind::Rattles);
        assert!(line.round.abs() < 1e-9 && (line.reach - 0.9).abs() < 1e-2, "{line:?}");
        // 4 x 0.9 of the play in each of its rounds, of which there are ten in a turn of 2 pi.
        assert!((line.speed_ratio.unwrap() / (10.0 * 3.6 / TAU) - 1.0).abs() < 1e-2, "{line:?}");
        // At rest on its land.
        let rest = moved(|_| Vector2::new(0.0, -1e-4));
        assert_eq!((rest.kind, rest.reach, rest.whirl_ratio), (Kind::Stable, 0.0, None));
        assert!((rest.eccentricity - 1.0).abs() < 1e-12 && (rest.share.unwrap() - 0.25).abs() < 1e-9);
        assert!(Orbit::of(&[], 1e-4).is_none());
        // Nobody touches it.
        let free = |step: i32| {
            let time = 1e-3 * f64::from(step);
            let centre = Vector2::new(1e-3 * time, 0.0);
            let (pocket_load, land_load, power, losses) = (0.0, 0.0, 0.0, 12.0);
            Place { time, centre, turned: 100.0 * time, pocket_load, land_load, power, losses }
        };
        let free = Orbit::of(&(0..100).map(free).collect::<Vec<_>>(), 1e-4).unwrap();
        assert!(free.kind == Kind::Stable && free.reach > 0.4, "{free:?}");
    }
}
