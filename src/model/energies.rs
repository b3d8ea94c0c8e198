//! Energies that a run puts in, loses and stores, and what a step leaves of it unaccounted for.

use serde::{Deserialize, Serialize};

use crate::contact::pair::PairForces;

/// Powers at one instant \[W].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Powers {
    /// Put in by races, applied loads, drives, gravity and the motion of the frame.
    pub input: f64,
    /// Lost to friction in the contacts.
    pub friction: f64,
    /// Lost to contact damping.
    pub damping: f64,
    /// Lost to what is around the bearing: drag of the medium, dampers of supports.
    pub around: f64,
}

/// Energies \[J]: sums since the start, and what is stored now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Work put in, less what was taken out.
    pub input: f64,
    /// Work of every step, whether it put in or took out: a load that swings does work both ways, and little is left of it.
    pub worked: f64,
    /// Put in by contacts whose stiffness changes with the contact angle.
    pub stiffened: f64,
    /// Lost to friction.
    pub friction: f64,
    /// Lost to contact damping.
    pub damping: f64,
    /// Lost to what is around the bearing.
    pub around: f64,
    /// Kinetic and elastic energy at the end of the last step, where the steps look at energy.
    pub stored: f64,
    /// Put in, but neither lost nor stored, there.
    pub unaccounted: f64,
}

impl Powers {
    /// Those of the trapezoidal rule.
    fn between(before: &Self, after: &Self) -> Self {
        let mean = |of: fn(&Self) -> f64| 0.5 * (of(before) + of(after));
        Self {
            input: mean(|powers| powers.input),
            friction: mean(|powers| powers.friction),
            damping: mean(|powers| powers.damping),
            around: mean(|powers| powers.around),
        }
    }

    /// Adds a part of others.
    pub fn add_part(&mut self, part: f64, of: &Self) {
        self.input += part * of.input;
        self.friction += part * of.friction;
        self.damping += part * of.damping;
        self.around += part * of.around;
    }
}

impl Energies {
    /// [-] of the stored energy: less is rounding, where nearly nothing is put in or lost.
    const ROUNDING: f64 = 1e-6;
    /// [-] part of the allowed share that a step may take of its own losses, whatever was left before.
    const OF_LOSSES: f64 = 0.5;
    /// [-] of the kinetic energy exchanged in a step: steps of some 1/200 of a period.
    const OF_EXCHANGE: f64 = 1e-4;
    /// [-] error of a step that leaves too much: it is taken again with 0.7 of its size. Cuts to 0.4 took twice the steps and left
    /// more open (docs/accuracy-cost.md): a deep cut in the middle of an impact breaks the symmetry of approach and rebound.
    const TOO_MUCH: f64 = 2.0;

    /// Adds a step of `h` \[s] by the trapezoidal rule: from powers before and after it, and what changes of stiffness put in \[J].
    /// Returns what that leaves to be stored \[J].
    pub fn add(&mut self, (before, after): (&Powers, &Powers), h: f64, stiffened: f64) -> f64 {
        self.add_mean(&Powers::between(before, after), h, stiffened)
    }

    /// Adds a step of `h` \[s] by its mean powers.
    pub fn add_mean(&mut self, mean: &Powers, h: f64, stiffened: f64) -> f64 {
        let Powers { input, friction, damping, around } = *mean;
        let [input, friction, damping, around] = [input, friction, damping, around].map(|power| h * power);
        self.put_in(input);
        self.stiffened += stiffened;
        self.friction += friction;
        self.damping += damping;
        self.around += around;
        input + stiffened - friction - damping - around
    }

    /// Adds work of a step \[J].
    pub fn put_in(&mut self, work: f64) {
        self.input += work;
        self.worked += work.abs();
    }

    /// \[J] lost since the start.
    pub fn lost(&self) -> f64 {
        self.friction + self.damping + self.around
    }

    /// \[J] what errors of the energy are measured by: all that was put in and taken out since the start, or the losses, whichever
    /// is more. The difference of what was put in and taken out is no measure: it passes through zero while races swing under
    /// their loads.
    pub fn turned_over(&self) -> f64 {
        self.worked.max(self.lost())
    }

    /// Compares what a step left to be stored with what is stored at its end \[J].
    pub fn close(&mut self, left: f64, stored: f64) {
        self.unaccounted += left - (stored - self.stored);
        self.stored = stored;
    }

    /// \[J] what a run may leave unaccounted for where a part `allowed` of what it has turned over may be.
    fn budget(&self, allowed: f64) -> f64 {
        (allowed * self.turned_over()).max(Self::ROUNDING * self.stored)
    }

    /// Has a run left well less than that? Three quarters are kept by runs that lose much, and the rest is there for those that lose little.
    pub fn is_frugal(&self, allowed: f64) -> bool {
        self.unaccounted.abs() <= 0.75 * self.budget(allowed)
    }

    /// [-] error of a step by its energy, 1 or less where it may be accepted: a budget over the whole run. A part `allowed` of what the
    /// run has turned over may be unaccounted for. A step that would leave more is too long, unless it leaves no
    /// more than half that part of its own losses, or a small part of the kinetic energy that came and went (`exchanged` \[J]),
    /// which even a run that loses nothing need not beat. Where the budget holds the error is 0: steps are those of a run that
    /// does not look at energy.
    pub fn error_since(&self, before: &Self, exchanged: impl FnOnce() -> f64, allowed: f64) -> f64 {
        let budget = self.budget(allowed);
        let (left, of_step) = (self.unaccounted.abs(), (self.unaccounted - before.unaccounted).abs());
        if of_step.is_nan() {
            return f64::NAN;
        }
        // What makes good an earlier error is welcome.
        let kept = left <= budget.max(before.unaccounted.abs())
            || of_step <= Self::OF_LOSSES * allowed * (self.lost() - before.lost())
            || of_step <= Self::OF_EXCHANGE * exchanged();
        if kept { 0.0 } else { Self::TOO_MUCH }
    }
}

/// A ball on a race: what the energy of a Hertz contact `0.4 K delta^2.5` is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressed {
    /// [N/m^1.5] Hertz stiffness K.
    stiffness: f64,
    /// [m^2.5] approach to the power 2.5; 0 without contact.
    depth: f64,
}

impl Pressed {
    /// Energies of a contact as it is now.
    pub fn new(contact: &PairForces) -> Self {
        let approach = contact.approach.max(0.0);
        Self { stiffness: contact.stiffness, depth: approach * approach * approach.sqrt() }
    }

    /// \[J] what a step puts in as the stiffness changes from that at its start: the curvature of a raceway, and the stiffness
    /// with it, depends on the contact angle, but the normal force does no work on that change.
    pub fn stiffened(&self, start: &Self) -> f64 {
        0.2 * (self.depth + start.depth) * (self.stiffness - start.stiffness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that lost 1 J of 1 J put in so far, but for what it left unaccounted for.
    fn after(unaccounted: f64) -> Energies {
        let input = 1.0 + unaccounted;
        Energies { input, worked: input, friction: 1.0, stored: 5.0, unaccounted, ..Energies::default() }
    }

    #[test]
    fn closed_form_energy_of_a_step() {
        let (before, now) = (after(0.0), Powers { input: 3.0, friction: 2.0, damping: 0.5, around: 0.4 });
        let start = Powers { input: 1.0, friction: 1.0, damping: 0.5, around: 0.0 };
        let mut energies = before;
        let left = energies.add((&start, &now), 0.1, 0.01);
        energies.close(left, 5.05);
        assert!((energies.input - 1.2).abs() < 1e-15 && energies.stiffened == 0.01);
        assert!((energies.friction - 1.15).abs() < 1e-15);
        assert!((energies.damping - 0.05).abs() < 1e-15 && energies.stored == 5.05);
        assert!((energies.around - 0.02).abs() < 1e-15);
        // 0.2 + 0.01 put in, 0.15 + 0.05 + 0.02 lost, 0.05 stored
        assert!((energies.unaccounted + 0.06).abs() < 1e-14);
    }

    #[test]
    fn closed_form_a_run_has_a_budget_of_energy() {
        let too_long = |before: f64, of_step: f64, lost: f64, exchanged: f64| {
            let start = after(before);
            let mut end = start;
            end.unaccounted += of_step;
            end.put_in(of_step + lost);
            end.friction += lost;
            end.error_since(&start, || exchanged, 0.01) > 1.0
        };
        // The 0.01 J that may be left of what was put in, in one step or in many.
        assert!(!too_long(0.0, 0.0099, 0.0, 0.0) && too_long(0.0, 0.0103, 0.0, 0.0));
        assert!(!too_long(-0.0095, -0.0004, 0.0, 0.0) && too_long(-0.0095, -0.0006, 0.0, 0.0));
        // Beyond it, half a percent of what the step lost, or a ten-thousandth of what came and went.
        assert!(!too_long(0.02, 1e-3, 0.21, 0.0) && too_long(0.02, 1e-3, 0.19, 0.0));
        assert!(!too_long(0.02, 1e-3, 0.0, 10.1) && too_long(0.02, 1e-3, 0.0, 9.9));
        // What makes good an earlier error is welcome.
        assert!(!too_long(0.02, -1e-3, 0.0, 0.0) && too_long(0.02, -0.05, 0.0, 0.0));
        // Work both ways counts, though nothing is left of it.
        let mut swings = Energies { stored: 5.0, ..Energies::default() };
        [1.0, -1.0].into_iter().for_each(|work| swings.put_in(work));
        assert_eq!((swings.input, swings.turned_over()), (0.0, 2.0));
        assert_eq!(Energies { unaccounted: 0.019, ..swings }.error_since(&swings, || 0.0, 0.01), 0.0);
        // A millionth of what is stored is rounding.
        let still = |unaccounted| Energies { stored: 5.0, unaccounted, ..Energies::default() };
        assert_eq!(still(4.9e-6).error_since(&still(0.0), || 0.0, 0.01), 0.0);
        assert!(still(5.1e-6).error_since(&still(0.0), || 0.0, 0.01) > 1.0);
        assert!(after(f64::NAN).error_since(&after(0.0), || 0.0, 0.01).is_nan());
    }

    #[test]
    fn closed_form_work_of_a_stiffness_that_changes() {
        let pressed = |stiffness: f64, approach: f64| {
            Pressed::new(&PairForces { stiffness, approach, ..PairForces::none() })
        };
        // At a constant approach the whole change of 0.4 K delta^2.5 is work of the stiffness.
        let (soft, stiff) = (pressed(1e9, 4e-6), pressed(1.1e9, 4e-6));
        assert!((stiff.stiffened(&soft) / (0.4 * 1e8 * 4e-6f64.powf(2.5)) - 1.0).abs() < 1e-12);
        assert_eq!(stiff.stiffened(&stiff), 0.0);
        assert_eq!(pressed(1e9, -1e-6).stiffened(&pressed(2e9, -2e-6)), 0.0);
    }
}
