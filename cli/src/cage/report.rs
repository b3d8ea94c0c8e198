//! Motions of cages under pushes, as text and as JSON.

use std::fmt::Write;

use roulement::effects::cage::Guidance;
use roulement::effects::estimate::{digits, percent};
use serde_json::{Value, json};

use super::{Cage, Kind, Orbit};

/// [-] turns of the cage in the time that is judged, below which a whirl may not have shown.
const FEW_TURNS: f64 = 1.0;

/// A table for each cage, and its verdict in a line.
pub fn to_text(cages: &[Cage]) -> String {
    let mut text = String::new();
    for cage in cages {
        // Writing to a string cannot fail.
        let _ = write_cage(&mut text, cage);
    }
    text
}

fn write_cage(out: &mut String, cage: &Cage) -> std::fmt::Result {
    if !cage.bearing.is_empty() {
        writeln!(out, "bearing {}", cage.bearing)?;
    }
    writeln!(
        out,
        "cage of {} g, guided by {}, play {} um in radius",
        digits(cage.mass * 1e3),
        guide(cage.guided_by),
        digits(cage.play * 1e6)
    )?;
    writeln!(
        out,
        "{:<10}{:<9}{:>9}{:>9}{:>8}{:>8}{:>8}{:>12}{:>11}{:>11}{:>11}",
        "push",
        "motion",
        "reach",
        "off axis",
        "round",
        "whirl",
        "speed",
        "pocket [N]",
        "land [N]",
        "power [W]",
        "share"
    )?;
    for (push, orbit) in &cage.pushed {
        match orbit {
            Ok(orbit) => writeln!(
                out,
                "{:<10}{:<9}{:>9.3}{:>9.3}{:>8.2}{:>8}{:>8}{:>12}{:>11}{:>11}{:>11}",
                push.name(),
                orbit.kind.name(),
                orbit.reach,
                orbit.eccentricity,
                orbit.round,
                orbit.whirl_ratio.map_or("-".into(), |ratio| format!("{ratio:.2}")),
                orbit.speed_ratio.map_or("-".into(), |ratio| format!("{ratio:.2}")),
                digits(orbit.pocket_load),
                digits(orbit.land_load),
                digits(orbit.power),
                orbit.share.map_or("-".into(), percent),
            )?,
            Err(why) => writeln!(out, "{:<10}did not run to its end: {why}", push.name())?,
        }
    }
    writeln!(out, "{}\n", sentence(cage))
}

fn guide(by: Guidance) -> &'static str {
    match by {
        Guidance::Inner => "the inner race",
        Guidance::Outer => "the outer race",
        Guidance::Balls => "the balls",
    }
}

/// The verdict: the kind of motion under the push that does most, and its numbers.
fn sentence(cage: &Cage) -> String {
    let Some((push, orbit)) = cage.worst() else {
        return "verdict: none, as no run came to its end".into();
    };
    let named = |kind: Kind| {
        let done = cage.pushed.iter().filter(|(_, of)| of.as_ref().is_ok_and(|of| of.kind == kind));
        done.map(|(push, _)| push.name()).collect::<Vec<_>>().join(", ")
    };
    let kinds = [Kind::Rattles, Kind::Whirls, Kind::Stable].map(|kind| (kind, named(kind)));
    let kinds = kinds.iter().filter(|(_, pushes)| !pushes.is_empty());
    let kinds: Vec<String> = kinds.map(|(kind, pushes)| format!("{} ({pushes})", kind.name())).collect();
    format!("verdict: {}; under \"{}\" {}", kinds.join(", "), push.name(), numbers(orbit))
}

fn numbers(orbit: &Orbit) -> String {
    let whirl = orbit.whirl_ratio.map_or("none".into(), |ratio| format!("{ratio:.2}"));
    let share = orbit.share.map_or("no share".into(), percent);
    let few = if orbit.turns < FEW_TURNS {
        format!("; judged over {:.2} turns of the cage: a longer load.duration tells more", orbit.turns)
    } else {
        String::new()
    };
    format!(
        "whirl ratio {whirl}, up to {} N in a pocket and {} N on a land, {} W: {share} of all losses{few}",
        digits(orbit.pocket_load),
        digits(orbit.land_load),
        digits(orbit.power)
    )
}

/// The same, with the ways of the centres.
pub fn to_json(cages: &[Cage]) -> Value {
    let of_cage = |cage: &Cage| {
        let pushes = cage.pushed.iter().map(|(push, orbit)| {
            let mut value = json!({ "push": push.name() });
            match orbit {
                Ok(orbit) => {
                    value["motion"] = orbit.kind.name().into();
                    value["reach"] = orbit.reach.into();
                    value["eccentricity"] = orbit.eccentricity.into();
                    value["round"] = orbit.round.into();
                    value["whirl_ratio"] = json!(orbit.whirl_ratio);
                    value["speed_ratio"] = json!(orbit.speed_ratio);
                    value["turns"] = orbit.turns.into();
                    value["pocket_load"] = orbit.pocket_load.into();
                    value["land_load"] = orbit.land_load.into();
                    value["power"] = orbit.power.into();
                    value["share"] = json!(orbit.share);
                    value["way"] = json!(orbit.way);
                }
                Err(why) => value["why_not"] = why.as_str().into(),
            }
            value
        });
        json!({
            "bearing": cage.bearing,
            "play": cage.play,
            "mass": cage.mass,
            "verdict": cage.worst().map(|(_, orbit)| orbit.kind.name()),
            "worst": cage.worst().map(|(push, _)| push.name()),
            "sentence": sentence(cage),
            "pushes": pushes.collect::<Vec<_>>(),
        })
    };
    cages.iter().map(of_cage).collect::<Vec<_>>().into()
}
