//! Where the groove of a race ends: a shoulder on either side.
//!
//! A groove of radius `r` with a shoulder of height `h` over its bottom ends at a contact angle of `acos(1 - h/r)`. A contact
//! at angle `a` whose ellipse is seen from the ball's centre under the half angle `b` is cut off at `t = (end - |a|)/b` of its
//! semi-axis; beyond lies the share `(1 - t)^2 (2 + t)/4` of a Hertzian load.

use std::f64::consts::PI;

/// [-] load of a contact over the largest of its race below which its place is not looked at: balls that others leave without
/// load rattle about their groove.
pub const SMALL_LOAD: f64 = 0.05;

/// \[rad] distance from the end of a groove within which the angle of a contact is computed.
const CLEAR: f64 = 5.0 * PI / 180.0;

/// Largest share beyond the shoulders of a race among contacts that carry load, by their loads \[N] and shares.
pub fn largest_share(contacts: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let largest = contacts.clone().fold(0.0, |largest: f64, (load, _)| largest.max(load));
    contacts.filter(|(load, _)| *load > SMALL_LOAD * largest).fold(0.0, |most, (_, share)| share.max(most))
}

/// \[rad] smallest margin of a race among contacts that carry load, by their loads \[N] and margins; a right angle where none does.
pub fn least_margin(contacts: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let largest = contacts.clone().fold(0.0, |largest: f64, (load, _)| largest.max(load));
    let loaded = contacts.filter(|(load, _)| *load > SMALL_LOAD * largest);
    loaded.fold(std::f64::consts::FRAC_PI_2, |least, (_, margin)| margin.min(least))
}

/// \[rad] half angle under which an ellipse is seen from the ball's centre: transverse semi-axis and radius of the ball \[m].
pub fn half_angle(semi_axis: f64, radius: f64) -> f64 {
    (semi_axis / radius).min(1.0).asin()
}

/// Ends of a groove as contact angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shoulders {
    /// \[rad] at the -x and the +x side of the race, both positive.
    pub ends: [f64; 2],
}

/// A contact that lies beyond a shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beyond {
    /// Side of the race: 0 towards -x, 1 towards +x.
    pub side: usize,
    /// \[rad] contact angle, positive.
    pub angle: f64,
    /// \[rad] contact angle at which the groove ends there.
    pub end: f64,
}

impl Shoulders {
    /// \[rad] where a groove of a radius \[m] ends under a shoulder of a height \[m].
    pub fn end(height: f64, groove_radius: f64) -> f64 {
        (1.0 - height / groove_radius).clamp(0.0, 1.0).acos()
    }

    /// [-] share of a Hertzian load beyond the shoulders, of a contact at an angle \[rad] towards +x with a half angle of its
    /// ellipse \[rad].
    pub fn share_beyond(&self, towards_x: f64, half_angle: f64) -> f64 {
        let share = |margin: f64| {
            let t = if half_angle > 0.0 { (margin / half_angle).clamp(-1.0, 1.0) } else { 1.0 };
            0.25 * (1.0 - t).powi(2) * (2.0 + t)
        };
        share(self.ends[0] + towards_x) + share(self.ends[1] - towards_x)
    }

    /// \[rad] distance of an ellipse, of a contact at an angle \[rad] towards +x with a half angle of its ellipse \[rad], from the
    /// nearer end of the groove; negative where it is cut.
    pub fn margin(&self, towards_x: f64, half_angle: f64) -> f64 {
        (self.ends[0] + towards_x).min(self.ends[1] - towards_x) - half_angle
    }

    /// Is a contact far from both shoulders, by more than five degrees? By sine and cosine, times any length, of its angle towards +x: angles
    /// themselves would cost more than all else that is looked at in a communication point.
    pub fn clear(&self) -> impl Fn((f64, f64)) -> bool + use<> {
        let [minus_x, plus_x] = self.ends.map(|end| (end - CLEAR).tan());
        move |(sine, cosine)| -minus_x * cosine < sine && sine < plus_x * cosine
    }

    /// Is a contact at an angle \[rad] towards +x beyond a shoulder?
    pub fn beyond(&self, towards_x: f64) -> Option<Beyond> {
        let side = usize::from(towards_x > 0.0);
        let (angle, end) = (towards_x.abs(), self.ends[side]);
        (angle > end).then_some(Beyond { side, angle, end })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn closed_form_what_is_clear_of_the_shoulders_is_five_degrees_from_both() {
        for ends in [[0.3, 0.9], [1.2, FRAC_PI_2], [0.05, 0.5]] {
            let shoulders = Shoulders { ends };
            let clear = shoulders.clear();
            for k in -900..=900 {
                let angle = f64::from(k) * 1e-3 * FRAC_PI_2 / 0.9;
                let (sine, cosine) = angle.sin_cos();
                let margin = shoulders.margin(angle, 0.0);
                // To the rounding of the slopes.
                if (margin - CLEAR).abs() > 1e-12 {
                    assert_eq!(clear((0.7 * sine, 0.7 * cosine.abs())), margin > CLEAR, "{ends:?} {angle}");
                }
                assert!(shoulders.beyond(angle).is_none() || margin < 0.0);
            }
        }
        assert!(!Shoulders { ends: [1.0; 2] }.clear()((f64::NAN, 1.0)));
    }
}
