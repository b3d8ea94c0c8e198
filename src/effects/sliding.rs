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
/// Most steps for the creepage; where the power has kinks, a step halves what is left.
const STEPS: usize = 40;
/// [-] change of the creepage over the slip of the groove that counts as none. The power is least there: it changes by about its square.
const SETTLED: f64 = 1e-7;

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

    /// \[K] warming of the bearing by this friction power, which goes out through the seats of both rings, and to oil whose conductance
    /// is known.
    pub fn heating(&self) -> f64 {
        self.friction_power() / (self.outline.seats().iter().sum::<f64>() + self.oil_conductance)
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
    let places = places();
    let of_ball = |ball: usize| -> [f64; 2] {
        let of: Vec<_> = estimate.contacts.iter().filter(|contact| contact.ball == ball).collect();
        // A ball that one race alone carries spins on the other for nothing.
        if of.len() < 2 {
            return [0.0, of.iter().map(|contact| rolling(contact, bent(contact))).sum()];
        }
        let spin = of.iter().map(|contact| contact.spin.abs()).fold(0.0, f64::max);
        let shared = |outer: f64| {
            let power = |contact: &&ContactEstimate| {
                let share = if contact.race == 0 { 1.0 - outer } else { outer };
                sliding(contact, share * spin, bent(contact), &places)
            };
            of.iter().map(power).sum::<f64>()
        };
        // Spin alone takes power in proportion: all of it is on the race where it takes less.
        let alone = of.iter().map(|contact| spinning(contact, spin, &places)).fold(f64::INFINITY, f64::min);
        let together = (0..=SHARES).map(|k| shared(k as f64 / SHARES as f64)).fold(f64::INFINITY, f64::min);
        [alone, together]
    };
    let balls = estimate.contacts.iter().map(|contact| contact.ball + 1).max().unwrap_or(0);
    let powers: Vec<_> = (0..balls).map(of_ball).collect();
    [0, 1].map(|groove| estimate.friction * powers.iter().map(|power| power[groove]).sum::<f64>())
}

/// Places over a half of the ellipse, along and across rolling over its semi-axes, which carry as much load each.
type Places = [[f64; 2]; RINGS * RAYS];

fn places() -> Places {
    std::array::from_fn(|index| {
        let (ring, ray) = (index / RAYS, index % RAYS);
        // A Hertzian load is uniform in the cube of its height over the ellipse.
        let height = ((ring as f64 + 0.5) / RINGS as f64).cbrt();
        let radius = (1.0 - height * height).sqrt();
        let (y, x) = (PI * ((ray as f64 + 0.5) / RAYS as f64 - 0.5)).sin_cos();
        [radius * x, radius * y]
    })
}

/// \[W] power of a contact without spin over the friction coefficient, by the slip of its groove at the end of the ellipse \[m/s].
fn rolling(contact: &ContactEstimate, bent: f64) -> f64 {
    FREE_ROLLING * contact.load * bent
}

/// \[W] power of a contact over the friction coefficient by its spin [rad/s] alone.
fn spinning(contact: &ContactEstimate, spin: f64, places: &Places) -> f64 {
    let [along, across] = contact.semi_axes.map(|axis| axis * spin);
    let slips = places.iter().map(|[x, y]| (across * y).hypot(along * x));
    contact.load * slips.sum::<f64>() / places.len() as f64
}

/// \[W] power of a contact over the friction coefficient, free to roll: angular velocity of spin [rad/s], slip of its groove at the end
/// of the ellipse \[m/s].
fn sliding(contact: &ContactEstimate, spin: f64, bent: f64, places: &Places) -> f64 {
    if spin == 0.0 {
        return rolling(contact, bent);
    }
    let [along, across] = contact.semi_axes.map(|axis| axis * spin);
    // Slip along rolling with no creepage, and across it.
    let slips = places.map(|[x, y]| [bent * y * y - across * y, along * x]);
    // Least power: no force along rolling. Newton's method on that force, between creepages where it has either sign.
    let (mut low, mut high) = (-bent, bent);
    let mut creep = 0.0;
    for _ in 0..STEPS {
        let (mut force, mut slope) = (0.0, 0.0);
        for [forwards, sideways] in slips {
            let (forwards, square) = (forwards - creep, sideways * sideways);
            let inverse = 1.0 / (forwards * forwards + square).sqrt();
            force += forwards * inverse;
            slope += square * inverse * inverse * inverse;
        }
        if force > 0.0 {
            low = creep;
        } else {
            high = creep;
        }
        let newton = creep + force / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - creep).abs();
        creep = next;
        if step <= SETTLED * bent {
            break;
        }
    }
    let power: f64 = slips.iter().map(|[forwards, sideways]| (forwards - creep).hypot(*sideways)).sum();
    contact.load * power / slips.len() as f64
}
