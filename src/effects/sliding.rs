//! Friction power of complete sliding: spin and slip of bent grooves, alone and together, in all contacts of a bearing.
//!
//! Creep laws come close to it wherever contacts spin; what is left out is the elastic slip of small creepages and what balls take to
//! carry their gyroscopic moments.

use std::f64::consts::PI;

use super::estimate::{ContactEstimate, Estimate};
use crate::contact::film::FREE_ROLLING;
use crate::numerics::elliptic::complete_elliptic_integrals;

/// Rings and rays of the quadrature over a half of the ellipse.
const RINGS: usize = 8;
const RAYS: usize = 8;
/// Parts that the spin of a ball is shared out to both races in.
const SHARES: usize = 8;
/// Steps of the golden section for the creepage.
const SECTIONS: usize = 24;

impl Estimate {
    /// \[W] friction power of complete sliding, as if spin and slip of grooves each acted alone.
    pub fn friction_power(&self) -> f64 {
        powers_alone(self).into_iter().sum()
    }

    /// [-] part of the slip of grooves in it.
    pub fn groove_share(&self) -> f64 {
        let [spin, groove] = powers_alone(self);
        if groove > 0.0 { groove / (spin + groove) } else { 0.0 }
    }

    /// \[K] warming of the bearing by this friction power, which goes out through the seats of both rings.
    pub fn heating(&self) -> f64 {
        self.friction_power() / self.outline.seats().iter().sum::<f64>()
    }
}

/// \[W] power of spin and of groove slip as if each acted alone, all spin on the inner race.
pub fn powers_alone(estimate: &Estimate) -> [f64; 2] {
    let of = |power: fn(&ContactEstimate) -> f64| {
        estimate.friction * estimate.contacts.iter().map(power).sum::<f64>()
    };
    [
        of(|contact| contact.load * spin_arm(contact) * contact.spin.abs()),
        of(|contact| FREE_ROLLING * contact.load * bent(contact)),
    ]
}

/// \[m] moment of complete spin over the friction force.
fn spin_arm(contact: &ContactEstimate) -> f64 {
    let [along, across] = contact.semi_axes;
    let (long, short) = (along.max(across), along.min(across));
    let (_, second) = complete_elliptic_integrals(1.0 - (short / long).powi(2));
    0.375 * long * second
}

/// [m/s] slip of a bent groove at the end of the long axis against its middle.
fn bent(contact: &ContactEstimate) -> f64 {
    contact.bend * contact.rolling.abs() * contact.semi_axes[1].powi(2)
}

/// \[W] power of both together, without and with the slip of grooves. Each ball's spin goes to the races such that the power is
/// least, which is where its friction moments are in balance.
pub fn powers_together(estimate: &Estimate) -> [f64; 2] {
    let of_ball = |ball: usize, groove: f64| {
        let of: Vec<_> = estimate.contacts.iter().filter(|contact| contact.ball == ball).collect();
        let spin = of.iter().map(|contact| contact.spin.abs()).fold(0.0, f64::max);
        let shared = |outer: f64| {
            of.iter()
                .map(|contact| {
                    let share = if contact.race == 0 { 1.0 - outer } else { outer };
                    sliding(contact, share * spin, groove * bent(contact))
                })
                .sum::<f64>()
        };
        // A ball that one race alone carries spins on the other for nothing.
        if of.len() < 2 {
            return of.iter().map(|contact| sliding(contact, 0.0, groove * bent(contact))).sum();
        }
        (0..=SHARES).map(|k| shared(k as f64 / SHARES as f64)).fold(f64::INFINITY, f64::min)
    };
    let balls = estimate.contacts.iter().map(|contact| contact.ball + 1).max().unwrap_or(0);
    [0.0, 1.0].map(|groove| estimate.friction * (0..balls).map(|ball| of_ball(ball, groove)).sum::<f64>())
}

/// \[W] power of a contact over the friction coefficient, free to roll: angular velocity of spin [rad/s], slip of its groove at the end
/// of the ellipse [m/s].
fn sliding(contact: &ContactEstimate, spin: f64, bent: f64) -> f64 {
    if spin == 0.0 {
        return FREE_ROLLING * contact.load * bent;
    }
    let [along, across] = contact.semi_axes.map(|axis| axis * spin);
    let power = |creep: f64| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for ring in 0..RINGS {
            // A Hertzian load is uniform in the cube of its height over the ellipse.
            let height = ((ring as f64 + 0.5) / RINGS as f64).cbrt();
            let radius = (1.0 - height * height).sqrt();
            for ray in 0..RAYS {
                let (y, x) = (PI * ((ray as f64 + 0.5) / RAYS as f64 - 0.5)).sin_cos();
                let (x, y) = (radius * x, radius * y);
                sum += (bent * y * y - creep - across * y).hypot(along * x);
                weights += 1.0;
            }
        }
        contact.load * sum / weights
    };
    // Least power: no force along rolling.
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    let (mut low, mut high) = (-bent, bent);
    for _ in 0..SECTIONS {
        let width = golden * (high - low);
        let (left, right) = (high - width, low + width);
        if power(left) < power(right) { high = right } else { low = left }
    }
    power(0.5 * (low + high))
}
