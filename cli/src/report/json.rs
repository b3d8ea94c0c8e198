//! Reports as JSON. Numbers are SI and read back to the same bits; what is not a number is null.

use roulement::Scene;
use roulement::effects::estimate::Verdict;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::System;
use serde_json::{Map, Value, json};

use super::figures::{Figures, Shown};
use super::means::{Mean, Means};
use crate::watch::{BearingSeen, Seen, ShaftSeen};

/// Summary of a run, with error bars where figures have them: of a bearing alone, or of each bearing of a shaft by its name, and of the
/// shaft as `shaft`. Figures are those of the bearings, then of the shaft.
pub fn of_machine(machine: &Machine, seen: &Seen, shown: &[Shown]) -> Value {
    let bearings = machine.bearings().zip(&seen.bearings).zip(shown);
    let mut all: Map<String, Value> = bearings
        .map(|(((name, bearing), seen), shown)| (name.to_string(), summary(bearing, seen, shown)))
        .collect();
    if let (Some(system), Some(seen), Some(shown)) = (machine.shaft(), &seen.shaft, shown.last()) {
        all.insert("shaft".into(), of_shaft(system, seen, shown));
        return Value::Object(all);
    }
    all.into_iter().next().map_or(Value::Null, |(_, of_bearing)| of_bearing)
}

/// Summary of a shaft with its housings.
pub fn of_shaft(system: &System, seen: &ShaftSeen, shown: &Shown) -> Value {
    json!({
        "title": system.scene().title,
        "time": system.time(),
        "figures": figures(&shown.figures),
        "error_bars": shown.bars.as_ref().map(figures),
        "means": seen.means.as_ref().map(means),
        "warnings": seen.warnings(system),
    })
}

/// Summary of a bearing.
pub fn summary(simulation: &Simulation, seen: &BearingSeen, shown: &Shown) -> Value {
    let statistics = &simulation.outputs().statistics;
    json!({
        "title": simulation.scene().title,
        "time": simulation.time(),
        "figures": figures(&shown.figures),
        "error_bars": shown.bars.as_ref().map(figures),
        "error_estimate": seen.estimate.errors(simulation).map(|[histories, means]| json!({ "histories": histories, "means": means })),
        "means": seen.means.as_ref().map(means),
        "peak_pressure": seen.limits.peak_pressure,
        "energy_balance": seen.energy.balance(simulation.outputs()),
        "warning": seen.energy.warning(simulation),
        "steps": {
            "accepted": statistics.steps,
            "rejected_by_error": statistics.rejected_error,
            "rejected_by_newton": statistics.rejected_newton,
        },
    })
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
    let settled = means.can_tell().then(|| means.unsettled().next().is_none());
    json!({
        "window": means.window,
        "settled": settled,
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
        "estimates": serde_json::to_value(verdicts)?,
    }))
}
