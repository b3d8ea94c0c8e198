//! Measured changes, as text and as JSON.

use roulement::effects::estimate::{percent, signed_percent};
use serde_json::{Value, json};

use super::Measured;
use super::changed::Changed;

/// A line for each effect of each bearing, the largest change first.
pub fn to_text(measured: &[Measured]) -> String {
    let line = |one: &Measured| {
        let of = if one.pair.name.is_empty() { String::new() } else { format!("{}: ", one.pair.name) };
        let is = if one.pair.on { "on" } else { "off" };
        let head = format!("{of}{:<25} {is:<4}", one.pair.subject);
        let setting = match one.pair.setting.as_str() {
            "" => String::new(),
            setting => format!("; as {setting}"),
        };
        match &one.result {
            Ok(changed) => format!("{head} {}{setting}", words(changed)),
            Err(why) => format!("{head} not measured: {why}{setting}"),
        }
    };
    measured.iter().map(|one| line(one) + "\n").collect()
}

fn words(changed: &Changed) -> String {
    let (quantity, change, bar) = changed.largest().unwrap_or(("torque", f64::NAN, f64::NAN));
    let one = |(name, change): (&str, f64), bar: f64| {
        format!("{name} {} +- {}", signed_percent(change), percent(bar))
    };
    let others = changed.changes.known().zip(changed.bars.known()).filter(|((name, _), _)| *name != quantity);
    let others: Vec<String> = others.map(|(of, (_, bar))| one(of, bar)).collect();
    format!("{}; {}; CPU {}", one((quantity, change), bar), others.join(", "), signed_percent(changed.cpu))
}

/// The same, shares; with the CPU time as it was on this machine.
pub fn to_json(measured: &[Measured]) -> Value {
    let one = |one: &Measured| {
        let pair = &one.pair;
        let mut value = json!({
            "bearing": pair.name,
            "key": pair.key,
            "subject": pair.subject,
            "standing": if pair.on { "on" } else { "off" },
            "setting": pair.setting,
            "from": "two runs",
        });
        match &one.result {
            Ok(changed) => {
                let (quantity, change, bar) = changed.largest().unwrap_or(("torque", f64::NAN, f64::NAN));
                value["quantity"] = quantity.into();
                value["change"] = change.into();
                value["error"] = bar.into();
                value["changes"] = json!(changed.changes);
                value["errors"] = json!(changed.bars);
                value["cpu"] = changed.cpu.into();
            }
            Err(why) => value["why_not"] = why.as_str().into(),
        }
        value
    };
    json!({ "units": "shares", "measured": measured.iter().map(one).collect::<Vec<_>>() })
}
