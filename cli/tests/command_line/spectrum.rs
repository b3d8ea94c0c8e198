//! The spectrum of a run: `spectrum.csv`, `spectrum.svg` and what the summary says of it.

use roulement::scene::Scene;

use super::*;

/// Columns of a spectrum by their names.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(text: &str) -> Self {
        let mut lines = text.lines();
        let header = lines.next().unwrap().split(',').map(str::to_string).collect();
        let rows = lines.map(|line| line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect());
        Self { header, rows: rows.collect() }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.header.iter().position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
        self.rows.iter().map(|row| row[at]).collect()
    }
}

/// Frequencies \[Hz] as the summary gives them: FTF, BPFO, BPFI, BSF and turns of the shaft.
fn marked(summary: &str) -> [f64; 5] {
    let line = summary.lines().find(|line| line.contains("mean FTF")).unwrap_or_else(|| panic!("{summary}"));
    let words: Vec<&str> = line.split([' ', ',']).collect();
    ["FTF", "BPFO", "BPFI", "BSF", "shaft"].map(|name| {
        let at = words.iter().position(|word| *word == name).unwrap();
        words[at + 1].parse().unwrap()
    })
}

#[test]
fn closed_form_a_spall_strikes_at_bpfo_and_waves_as_many_as_balls_at_bpfi() {
    let scratch = Scratch::new("spectrum");
    let output = roulement(&[
        "run",
        &scene("effects/order_spectrum"),
        "-o",
        &scratch.path("out"),
        "--columns",
        "inner.force.*",
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = String::from_utf8(output.stdout).unwrap();
    let [ftf, bpfo, bpfi, bsf, shaft] = marked(&summary);
    assert!((shaft - 200.0).abs() < 0.01 && ftf < bsf && bsf < bpfo && bpfo < bpfi, "{summary}");
    for word in ["TOO COARSE", "SHORT", "SMEARED", "FOLDED"] {
        assert!(!summary.contains(word), "{summary}");
    }

    let table = Table::read(&scratch.read("out/spectrum.csv"));
    let (frequency, order) = (table.column("frequency [Hz]"), table.column("order [1]"));
    let spacing = frequency[1];
    assert!((frequency[frequency.len() - 1] / 100e3 - 1.0).abs() < 0.01 && spacing < 20.0, "{spacing}");
    assert!(order.iter().zip(&frequency).all(|(order, f)| (order * shaft - f).abs() < 1e-3 * f + 1e-9));
    assert!(table.rows.iter().flatten().all(|x| x.is_finite()));
    let thrust = table.column("inner.force.x amplitude (Hann) [N]");
    let aside = table.column("inner.force.z amplitude (Hann) [N]");
    // The largest line within 10 % of a frequency is within one of it: of blows across the axis, and of the waves along it.
    for (line, force) in [(bpfo, &aside), (2.0 * bpfo, &aside), (bpfi, &thrust)] {
        let near = |k: &usize| (frequency[*k] / line - 1.0).abs() < 0.1;
        let largest =
            (0..frequency.len()).filter(near).max_by(|a, b| force[*a].total_cmp(&force[*b])).unwrap();
        println!("{:.1} N at {:.1} Hz, {line:.1} Hz expected", force[largest], frequency[largest]);
        assert!((frequency[largest] - line).abs() <= spacing, "{} {line}", frequency[largest]);
    }
    // Mean thrust: what the history says, too.
    let results = Table::read(&scratch.read("out/results.csv"));
    let force = results.column("inner.force.x [N]");
    let late = &force[force.len() / 2..];
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    assert!((thrust[0] / mean.abs() - 1.0).abs() < 1e-3, "{} {mean}", thrust[0]);
    // Parseval: the lines have the scatter of the history, but for the window's edges.
    let scatter = late.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / late.len() as f64;
    // A line of Hann's window spreads over lines whose squares sum to 1.5 of its own.
    let lines = thrust[1..].iter().map(|a| 0.5 * a * a).sum::<f64>() / 1.5;
    assert!((lines / scatter - 1.0).abs() < 0.15, "{lines} {scatter}");

    let peaks: Vec<&str> = summary.lines().filter(|line| line.starts_with("peak ")).collect();
    for (force, line) in [("force.x", "; BPFI "), ("force.z", " x BPFO ")] {
        assert!(peaks.iter().any(|peak| peak.contains(force) && peak.contains(line)), "{summary}");
    }
    // A name is of a line that the peak is on, within half the distance of two lines.
    for peak in &peaks {
        let by = peak.split(' ').find(|word| word.starts_with(['+', '-']) && word.len() > 1);
        let by: f64 = by.map_or(0.0, |by| by.parse().unwrap());
        assert!(by.abs() <= 0.5 * spacing, "{summary}");
    }
    let picture = scratch.read("out/spectrum.svg");
    for part in ["FTF", "BPFO", "BPFI", "BSF", "order", "force [N]", "moment [N m]"] {
        assert!(picture.contains(part), "{part}");
    }
    assert!(!picture.contains("NaN") && summary.contains("spectrum.svg"));
}

#[test]
fn a_spectrum_is_there_where_frequencies_are_asked_for_and_says_what_it_cannot_tell() {
    let scratch = Scratch::new("spectrum-words");
    let run = |changes: &[(&str, &str)]| {
        let _ = std::fs::remove_dir_all(scratch.path("out"));
        let output = scratch.run(&edited("thrust", changes), "out", &[]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let there =
            ["spectrum.csv", "spectrum.svg"].map(|name| Path::new(&scratch.path("out")).join(name).exists());
        (String::from_utf8(output.stdout).unwrap(), there)
    };
    let (silent, there) = run(&[("load.duration", "\"4 ms\"")]);
    assert!(there == [false; 2] && !silent.contains("\nspectrum "), "{silent}");
    let wanted = ("effects.frequency_outputs", "true");
    let (text, there) = run(&[wanted, ("load.duration", "\"4 ms\"")]);
    assert!(there == [true; 2] && text.contains("SHORT") && text.contains("load.duration = \""), "{text}");
    let coarse = ("load.output_interval", "\"2 ms\"");
    let (text, there) = run(&[wanted, coarse, ("load.duration", "\"80 ms\"")]);
    assert!(there == [true; 2] && text.contains("TOO COARSE"), "{text}");
    assert!(text.contains("load.output_interval = \""), "{text}");
    let (text, there) = run(&[wanted, ("load.duration", "\"0.2 ms\"")]);
    assert!(there == [false; 2] && text.contains("fewer than 16 rows"), "{text}");
    let ramp = ("load.inner_speed", "[[0, 500], [0.02, 1000]]");
    let (text, _) = run(&[wanted, ramp, ("load.duration", "\"20 ms\"")]);
    assert!(text.contains("SMEARED"), "{text}");
}

#[test]
fn closed_form_a_healthy_race_that_was_struck_rings_at_its_own_frequency() {
    let scratch = Scratch::new("rings");
    let text = include_str!("../../../tests/data/rest/ringing_race.toml");
    let struck = Scene::edited(text, [("load.duration", "\"400 ms\"")]).unwrap();
    let output = scratch.run(&struck, "out", &["--columns", "inner.force.y"]);
    let summary = String::from_utf8(output.stdout).unwrap();
    let peaks: Vec<&str> = summary.lines().filter(|line| line.starts_with("peak ")).collect();
    // The root of stiffness over mass is 691 Hz; the race swings so far that its contacts are softer by a few percent.
    let ring = peaks.iter().find(|peak| peak.contains("force.y")).unwrap_or_else(|| panic!("{summary}"));
    assert!(ring.ends_with("; own frequency of the race, 691 Hz"), "{summary}");
    // Nothing is damaged, and the force has none of the lines of damage.
    for peak in peaks.iter().filter(|peak| peak.contains("force")) {
        assert!(!["BPFO", "BPFI", "BSF"].iter().any(|name| peak.contains(name)), "{summary}");
    }
}

/// Teeth whose stiffness varies are heard in the bearings of both shafts, at their frequency, and named.
#[test]
fn closed_form_a_mesh_is_named_in_the_spectra_of_the_bearings_around_it() {
    let scratch = Scratch::new("spectrum-mesh");
    let text = crate::shaft_keeps::meshed()
        .replace("\"300 rpm\"", "\"3000 rpm\"")
        .replace("\"2 ms\"", "\"24 ms\"")
        .replace("damping_ratio = 0.1", "damping_ratio = 0.1\nstiffness_variation = [{ amplitude = \"30 %\" }]")
        .replace(
            "[[bearing]]\n",
            "[[bearing]]\nset = { effects = { creep = \"saturated\", heathcote_slip = false, frequency_outputs = true } }\n",
        );
    std::fs::write(scratch.path("gears.toml"), text).unwrap();
    let output = roulement(&["run", &scratch.path("gears.toml"), "-o", &scratch.path("out")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for bearing in ["one-left", "two-right"] {
        let summary = scratch.read(&format!("out/{bearing}/summary.txt"));
        let teeth =
            summary.lines().find(|line| line.contains("teeth gears ")).unwrap_or_else(|| panic!("{summary}"));
        let frequency: f64 = teeth.split(' ').rev().nth(1).unwrap().parse().unwrap();
        // 20 teeth at 50 turns a second.
        assert!((frequency - 1000.0).abs() < 0.5, "{teeth}");
        assert!(summary.lines().any(|line| line.contains("peak") && line.contains("; gears ")), "{summary}");
        let record: Value = serde_json::from_str(&scratch.read(&format!("out/{bearing}/run.json"))).unwrap();
        let marked = &record["spectrum"]["meshes"][0];
        assert!(marked[0] == "gears" && (marked[1].as_f64().unwrap() - frequency).abs() < 0.01, "{marked}");
        assert!(scratch.read(&format!("out/{bearing}/spectrum.svg")).contains("gears"));
    }
}
