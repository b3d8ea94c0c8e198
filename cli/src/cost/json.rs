//! A study as JSON, for other programs.

use serde_json::{Map, Value, json};
use strum::VariantArray;

use super::norms::Norm;
use super::regret::{PROMISED, Regret, Tried};
use super::{Point, SceneStudy};

/// Settings with their errors and costs, how steps where nothing is said keep their promise, and the sentences of the study.
pub fn of_study(study: &SceneStudy) -> Value {
    let settings = study.points.iter().map(|point| setting(study, point));
    let promise = study.regret.as_ref().map(|regret| match regret {
        Ok(regret) => promise(regret),
        Err(why) => json!({ "failed": why }),
    });
    json!({
        "name": study.name,
        "settings": settings.collect::<Vec<_>>(),
        "promise": promise,
        "says": { "settled": study.settled, "advice": study.advice, "promise": study.promise() },
    })
}

/// A setting: errors are relative, costs per simulated second.
fn setting(study: &SceneStudy, point: &Point) -> Value {
    let kind = point.lever.reference();
    let named = json!({
        "reference": <&str>::from(kind),
        "lever": point.lever.name(),
        "setting": point.label,
    });
    let measured = match &point.result {
        Ok(measured) => json!({
            "errors": Norm::VARIANTS.iter().map(|&norm| (norm.name().into(), measured.errors.get(norm).into())).collect::<Map<_, _>>(),
            "largest_error": measured.errors.worst(),
            "cpu": measured.cpu,
            "steps": measured.work.steps,
            "on_front": study.pareto(kind, None).iter().any(|(other, _, _)| std::ptr::eq(*other, point)),
        }),
        Err(why) => json!({ "failed": why }),
    };
    joined([named, measured])
}

/// Steps and tolerances that were tried, judged by the promise.
fn promise(regret: &Regret) -> Value {
    let tried = |tried: &Tried| {
        let judged = match &tried.result {
            Ok(judged) => json!({
                "kept": judged.keeps(),
                "error_over_promise": judged.over,
                "torque_history_error": judged.torque,
                "contact_evaluations": judged.evaluations,
                "cost_over_cheapest": regret.of(judged),
            }),
            Err(why) => json!({ "failed": why }),
        };
        joined([json!({ "steps": tried.label, "tolerance": tried.tolerance }), judged])
    };
    json!({
        "means": PROMISED[0],
        "histories": PROMISED[1],
        "cheapest_tolerance": regret.cheapest().map(|(cheapest, _)| cheapest.tolerance),
        "steps": regret.steps.iter().map(tried).collect::<Vec<_>>(),
        "tolerances": regret.tolerances.iter().map(tried).collect::<Vec<_>>(),
    })
}

/// Objects as one.
fn joined(objects: [Value; 2]) -> Value {
    let members = objects
        .into_iter()
        .filter_map(|object| if let Value::Object(members) = object { Some(members) } else { None });
    Value::Object(members.flatten().collect())
}
