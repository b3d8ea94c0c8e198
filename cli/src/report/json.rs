//! Reports as JSON. Numbers are SI and read back to the same bits; what is not a number is null.

use roulement::Scene;
use roulement::effects::estimate::Verdict;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::machine::Machine;
use serde_json::{Map, Value, json};

use super::figures::{Figures, Shown};
use super::losses::Closed;
use super::means::{Mean, Means};
use crate::watch::{Extreme, Life, Part, PerTurn, Phase, Seen, headlines};

/// Summary of a run, with error bars where figures have them: of a bearing alone, or of each bearing of a shaft by its name, and of the
/// shaft as `shaft`. Figures are those of the bearings, then of the shaft.
pub fn of_machine(machine: &Machine, seen: &Seen, shown: &[Shown]) -> Value {
    let all = seen.parts(machine).zip(shown);
    let mut all = all.map(|((name, part), shown)| (name, summary(part, shown)));
    if machine.shaft().is_none() {
        return all.next().map_or(Value::Null, |(_, alone)| alone);
    }
    all.map(|(name, part)| (if name.is_empty() { "shaft" } else { name }.to_string(), part)).collect()
}

/// Summary of a part of a machine.
pub fn summary(part: Part<'_>, shown: &Shown) -> Value {
    let gathered = part.gathered();
    let mut summary = json!({
        "title": part.title(),
        "time": part.time(),
        "figures": figures(&shown.figures),
        "error_bars": shown.bars.as_ref().map(figures),
        "means": gathered.means.as_ref().map(means),
        "losses": gathered.closed.as_ref().map(closed),
        "phases": phases(&gathered.phases, shown),
        "warnings": part.warnings(),
    });
    if let Part::Bearing(simulation, seen) = part {
        let statistics = &simulation.outputs().statistics;
        if let (Some(means), Some(_)) = (&gathered.means, &gathered.closed) {
            summary["losses"]["parts"] = parts_of_losses(means);
        }
        summary["life"] = seen.life.as_ref().map(life).into();
        summary["entering_slip_load"] = seen.entering.as_ref().map(per_turn).into();
        summary["effects"] =
            headlines(simulation).into_iter().map(|(row, value)| (row.name, value)).collect();
        summary["peak_pressure"] = seen.limits.peak_pressure.into();
        summary["energy_balance"] = seen.energy.balance(simulation.outputs()).into();
        summary["warning"] = seen.energy.warning(simulation).into();
        summary["steps"] = json!({
            "accepted": statistics.steps,
            "rejected_by_error": statistics.rejected_error,
            "rejected_by_newton": statistics.rejected_newton,
        });
    }
    summary
}

/// Losses of a bearing by part: mean powers \[W] and shares.
fn parts_of_losses(means: &Means) -> Value {
    let all = means.of(LOSSES[0].name);
    let parts = LOSSES[1..].iter().filter_map(|part| {
        let power = means.find(part.name)?.mean;
        let share = if all > 0.0 { power / all } else { 0.0 };
        Some(json!({ "name": part.name, "words": part.words, "power": power, "share": share }))
    });
    parts.collect()
}

/// Balance of losses: mean powers \[W].
fn closed(closed: &Closed) -> Value {
    let Closed { torque, other, stored, lost, .. } = closed;
    json!({ "torque_times_speed": torque, "other_work": other, "stored": stored, "lost": lost, "left_open": closed.left() })
}

/// The largest load times slip speed of balls that enter the load zone \[W], by turns of the balls.
fn per_turn(PerTurn { turns, mean, largest }: &PerTurn) -> Value {
    json!({ "turns": turns, "mean": mean, "largest": largest })
}

fn life(Life { life, hours, modified_hours }: &Life) -> Value {
    json!({
        "L10r": life.reference,
        "L10r_hours": hours,
        "modified": life.modified,
        "modified_hours": modified_hours,
        "equivalent_load": life.equivalent_load,
        "static_safety": life.static_safety,
        "load_rests_on": life.load_rests_on.name(),
    })
}

/// Phases by their names, in their order.
fn phases(phases: &[Phase], shown: &Shown) -> Value {
    let of = |phase: &Phase| {
        let mean = |mean: &Mean| {
            let extreme = phase.extreme(&mean.name);
            json!({
                "quantity": mean.name,
                "unit": mean.unit,
                "mean": mean.mean,
                "least": extreme.map(|extreme| extreme.least),
                "largest": extreme.map(|extreme| extreme.largest),
                "interval_95": mean.interval,
                "settled": mean.trend.as_ref().map(|trend| trend.settled),
                "drift": mean.trend.as_ref().map(|trend| trend.drift),
                "error": shown.bars.as_ref().map(|bars| bars.get(&phase.figure(&mean.name))),
            })
        };
        let peak = |peak: &Extreme| json!({ "quantity": peak.name, "unit": peak.unit, "least": peak.least, "largest": peak.largest });
        json!({
            "name": phase.name,
            "window": phase.means.window,
            "settled": phase.means.settled(),
            "script_changes": phase.means.scripted,
            "heat": phase.heat,
            "life": phase.life.as_ref().map(life),
            "damage": phase.life.as_ref().map(|life| life.life.damage),
            "quantities": phase.means.means.iter().map(mean).collect::<Vec<_>>(),
            "peaks": phase.peaks().map(peak).collect::<Vec<_>>(),
        })
    };
    phases.iter().map(of).collect()
}

fn figures(figures: &Figures) -> Value {
    Value::Object(figures.iter().map(|(name, value)| (name.to_string(), value.into())).collect::<Map<_, _>>())
}

fn means(means: &Means) -> Value {
    let of = |mean: &Mean| {
        json!({
            "quantity": mean.name,
            "unit": mean.unit,
            "mean": mean.mean,
            "interval_95": mean.interval,
            "settled": mean.trend.as_ref().map(|trend| trend.settled),
            "drift": mean.trend.as_ref().map(|trend| trend.drift),
            "error": mean.error.map(|error| error.mean),
            "history_error": mean.error.and_then(|error| error.history),
        })
    };
    let settled = means.settled();
    json!({
        "window": means.window,
        "settled": settled,
        "script_changes": means.scripted,
        "needed_duration": means.needed().filter(|_| settled == Some(false)),
        "quantities": means.means.iter().map(of).collect::<Vec<_>>(),
    })
}

/// Effects of a scene: how they are set, and which matter.
///
/// # Errors
/// If a verdict has no form in JSON.
pub fn effects(scene: &Scene, verdicts: &[Verdict]) -> Result<Value, serde_json::Error> {
    let settings = scene.effects.each().into_iter().map(|effect| {
        let setting = effect.setting().map_or(Value::Null, Value::from);
        (effect.info().key.to_string(), setting)
    });
    Ok(json!({
        "units": "shares unless unit says more; rad",
        "settings": settings.collect::<Map<_, _>>(),
        "estimates": serde_json::to_value(ranked(verdicts))?,
    }))
}

/// The largest change first; what is no share of anything last.
pub fn ranked(verdicts: &[Verdict]) -> Vec<&Verdict> {
    let rank = |verdict: &Verdict| if verdict.unit.is_empty() { verdict.value } else { f64::NEG_INFINITY };
    let mut ranked: Vec<&Verdict> = verdicts.iter().collect();
    ranked.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    ranked
}
