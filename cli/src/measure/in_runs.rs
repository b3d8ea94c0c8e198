//! Effects that runs alone tell of, no settled state: cage and damping.

use roulement::effects::cage::{CageKind, CageSection, Guidance, USUAL_CLEARANCE};
use roulement::effects::damping::Given;
use roulement::effects::estimate::{Estimate, digits};
use roulement::effects::twin::Twin;
use roulement::effects::{Effect, Effects};
use roulement::scene::units::{DissipationFactor, Inertia, Length, Mass};

/// [kg/m3] mass of a usual cage over the volume of all balls: 0.6 of that of steel balls.
const USUAL_MASS: f64 = 0.6 * 7800.0;
/// [s/m] damping where the scene has none: bouncing of balls ends within about 1 ms.
const USUAL_DAMPING: f64 = 0.02;

/// How they are taken in and out of effects.
pub fn twins(effects: &Effects, estimate: &Estimate) -> [Twin; 2] {
    [cage(effects, estimate), damping(effects)]
}

fn cage(effects: &Effects, estimate: &Estimate) -> Twin {
    let on = effects.cage.kind != CageKind::None;
    let usual = usual(estimate);
    let other = if on { (CageKind::None, None) } else { (CageKind::Body, Some(usual)) };
    let twin = Twin::new("effects.cage", "cage", on, move |effects| {
        (effects.cage.kind, effects.cage.section) = other;
    });
    let (mass, play) = (usual.mass.0 * 1e3, usual.pocket_clearance.0 * 1e3);
    let words =
        format!("a cage of {} g with {} mm in its pockets, guided by the balls", digits(mass), digits(play));
    twin.taken_as(if on { String::new() } else { words })
}

/// A cage that runs have where the scene has none.
fn usual(estimate: &Estimate) -> CageSection {
    let Estimate { ball_radius, pitch_radius, balls, .. } = *estimate;
    let mass = USUAL_MASS * balls as f64 * 4.0 / 3.0 * std::f64::consts::PI * ball_radius.powi(3);
    let polar = mass * pitch_radius * pitch_radius;
    CageSection {
        mass: Mass(mass),
        inertia: [polar, 0.5 * polar, 0.5 * polar].map(Inertia),
        unbalance: None,
        pocket_clearance: Length(USUAL_CLEARANCE * 2.0 * ball_radius),
        guided_by: Guidance::Balls,
        guidance_clearance: None,
        land_diameter: None,
        land_width: None,
        youngs_modulus: None,
        poisson_ratio: None,
        damping: None,
    }
}

fn damping(effects: &Effects) -> Twin {
    let on = Effect::setting(&effects.damping).is_some();
    let given = Given::Factor(DissipationFactor(if on { 0.0 } else { USUAL_DAMPING }));
    let twin = Twin::new("effects.damping", "damping", on, move |effects| effects.damping.given = given);
    twin.taken_as(if on { String::new() } else { format!("{USUAL_DAMPING} s/m") })
}
