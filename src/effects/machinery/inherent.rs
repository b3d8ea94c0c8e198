//! Verdicts on what every simulation has, and on what none has: forces of the balls' own motion, and the bending of rings.

use std::f64::consts::PI;

use super::estimate::{Estimate, Outline, Standing, Verdict, digits, percent};

/// [-] deflection of a thin ring under two opposite loads over `Q R^3/(E I)`: pi/4 - 2/pi.
const RING: f64 = PI / 4.0 - 2.0 / PI;

/// [-] deflection of an outer ring that nothing supports, under two opposite loads as large as the largest of a ball, over the
/// deepest approach.
pub fn ring_bending(estimate: &Estimate) -> f64 {
    let Outline { outside, width, .. } = estimate.outline;
    let (inside, outside) = (estimate.rings[1].bottom, 0.5 * outside);
    let inertia = width * (outside - inside).powi(3) / 12.0;
    let [_, load] = estimate.loads;
    let radius = 0.5 * (inside + outside);
    RING * load * radius.powi(3) / (estimate.youngs_modulus * inertia) / estimate.deepest
}

/// Its verdicts.
pub fn verdicts(estimate: &Estimate) -> Vec<Verdict> {
    let always = |subject, value: f64, sentence| {
        Verdict::new(
            subject,
            Standing::Always,
            (value, estimate.threshold),
            sentence,
            "simulated in every scene",
        )
    };
    let [largest, _] = estimate.loads;
    let centrifugal = estimate.centrifugal_force / largest;
    let gyroscopic = estimate.gyroscopic();
    let bending = ring_bending(estimate);
    let mut verdicts = vec![always(
        ("centrifugal force", "largest load"),
        centrifugal,
        format!(
            "{} N on the most loaded ball: {} of its load of {} N on the inner race",
            digits(estimate.centrifugal_force),
            percent(centrifugal),
            digits(largest)
        ),
    )];
    if estimate.friction > 0.0 {
        let sentence = format!(
            "{} N m on the most loaded ball: {} of what friction on the inner race can hold",
            digits(estimate.gyroscopic_moment.abs()),
            percent(gyroscopic)
        );
        verdicts.push(always(("gyroscopic moment", "friction limit"), gyroscopic, sentence));
    }
    if bending.is_finite() {
        verdicts.push(Verdict::new(
            ("bending of the outer ring", "deepest approach"),
            Standing::Missing,
            (bending, f64::INFINITY),
            format!(
                "without a housing, two opposite balls would bend a usual outer ring by {} times the deepest approach",
                digits(bending)
            ),
            "not simulated: rings are as stiff as in a housing; ovality is [form]",
        ));
    }
    verdicts
}
