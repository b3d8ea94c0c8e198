//! Whether the window of a study is in a settled state: errors of means in a run that still drifts are of the way to there.

use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::follows_time;

use crate::report::means::{Mean, Means, NEGLIGIBLE, Trend};

/// Quantities that a sentence names.
const NAMED: usize = 3;

/// A sentence on the window of a reference, with the means of every bearing by its name.
pub fn sentence(scene: &MachineScene, reference: &str, all: &[(String, Means)]) -> String {
    let [begin, end] = all.first().map_or([f64::NAN; 2], |(_, means)| means.window.map(|time| time * 1e3));
    let window = format!("the window of the {reference}, {begin:.4} to {end:.4} ms,");
    if all.iter().any(|(_, means)| !means.can_tell()) {
        return format!(
            "Too few rows to tell whether {window} has settled: lower load.output_interval of the scene."
        );
    }
    // Furthest beyond their noise first.
    let unsettled = |(name, means): &'_ (String, Means)| -> Vec<(String, Mean, Trend)> {
        let before = if name.is_empty() { String::new() } else { format!("{name}: ") };
        let of =
            |(mean, trend): (&Mean, &Trend)| (format!("{before}{}", mean.name), mean.clone(), trend.clone());
        means.unsettled().map(of).collect()
    };
    let mut drifting: Vec<_> = all.iter().flat_map(unsettled).collect();
    let beyond = |trend: &Trend| trend.drift.abs() / trend.noise.max(f64::MIN_POSITIVE);
    drifting.sort_by(|(.., a), (.., b)| beyond(b).total_cmp(&beyond(a)));
    if drifting.is_empty() {
        return format!(
            "All means over {window} have settled: no drift beyond noise or {NEGLIGIBLE} of their size."
        );
    }
    let named = drifting.iter().take(NAMED).map(|(name, mean, trend)| {
        let unit = if mean.unit == "1" { "" } else { mean.unit };
        let [drift, noise] =
            [trend.drift, trend.noise].map(|x| format!("{x:.1e} {unit}").trim_end().to_string());
        format!("{name} by {drift} (noise {noise})")
    });
    let mut named = named.collect::<Vec<_>>().join(", ");
    if drifting.len() > NAMED {
        named.push_str(&format!(", and {} more", drifting.len() - NAMED));
    }
    let needed = all.iter().try_fold(0.0, |longest, (_, means)| Some(f64::max(longest, means.needed()?)));
    let what = match (follows_time(scene), needed) {
        (true, _) => "the scene changes with its tables, and its means are of that change".into(),
        (false, Some(needed)) => format!("load.duration of about {needed:.4} s would settle them"),
        (false, None) => "no decay to be seen: run the scene far longer, or they never settle".into(),
    };
    format!("NOT SETTLED: over {window} means drift, {named}; {what}.")
}

#[cfg(test)]
mod tests {
    use roulement::Scene;

    use super::*;

    fn scene(speed: &str) -> MachineScene {
        let text = include_str!("../../../scenes/cost/thrust.toml");
        Scene::edited(text, [("load.inner_speed", speed)]).unwrap().into()
    }

    fn means(trends: Vec<Option<Trend>>) -> Vec<(String, Means)> {
        let mean = |trend| Mean {
            name: "friction power".into(),
            unit: "W",
            mean: 30.0,
            trend,
            interval: None,
            error: None,
        };
        let means = trends.into_iter().map(mean).collect();
        vec![(
            String::new(),
            Means { window: [0.01, 0.04], scripted: false, unstable: false, means, largest: [0.0; 3] },
        )]
    }

    fn trend(drift: f64, needed: Option<f64>) -> Option<Trend> {
        let settled = drift.abs() <= 0.1;
        Some(Trend { error: 0.01, drift, noise: 0.1, settled, needed })
    }

    #[test]
    fn every_case_has_its_words() {
        let steady = scene("\"6000 rpm\"");
        let of = |scene: &MachineScene, means: &[(String, Means)]| sentence(scene, "reference", means);
        let settled = means(vec![trend(0.05, None)]);
        assert!(of(&steady, &settled).starts_with("All means over the window of the reference, 10.0000 to"));
        let unknown = means(vec![trend(0.05, None), None]);
        assert!(of(&steady, &unknown).starts_with("Too few rows"));

        // The furthest is named first; the run is as long as the slowest of them needs.
        let decaying =
            means(vec![trend(0.2, Some(0.1)), trend(-9.0, Some(0.3)), trend(0.3, None), trend(0.3, None)]);
        let said = of(&steady, &decaying);
        assert!(
            said.contains("friction power by -9.0e0 W (noise 1.0e-1 W), friction power by 3.0e-1"),
            "{said}"
        );
        assert!(said.contains(", and 1 more; no decay"), "{said}");
        let slow = means(vec![trend(0.2, Some(0.1)), trend(-9.0, Some(0.3))]);
        assert!(of(&steady, &slow).contains("load.duration of about 0.3000 s would settle them"));
        // A script never settles.
        let scripted = scene("[[0.0, 0.0], [\"10 ms\", \"6000 rpm\"]]");
        assert!(of(&scripted, &slow).contains("the scene changes with its tables"));
    }
}
