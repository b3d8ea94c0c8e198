//! `roulement import` and `export`: gearboxes from REXS files and back.

use std::io::Write as _;

use super::*;

/// A self-written gearbox as programs of version 1.0 write it: XML, gears where their teeth begin, names of bearings in `name`.
const OLD: &str = include_str!("../data/rexs/two_shafts_1.0.rexs");
/// The same one as those of version 1.4 do: JSON, the second shaft from its other end, vectors in base64, loads in a spectrum.
const NEW: &str = include_str!("../../../examples/gearbox/two_shafts.rexsj");

/// Bearings in an equilibrium.
const BEARINGS: [&str; 2] = ["bearings", "bearings_by_stiffness"];

/// The machine of a file's text, and what is told of it.
fn imported(scratch: &Scratch, name: &str, bytes: &[u8]) -> (String, String) {
    std::fs::write(scratch.path(name), bytes).unwrap();
    let output = roulement(&["import", &scratch.path(name)]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{told}");
    (String::from_utf8(output.stdout).unwrap(), told)
}

/// Why a file is refused.
fn refusal(scratch: &Scratch, bytes: &[u8]) -> String {
    std::fs::write(scratch.path("refused.rexs"), bytes).unwrap();
    let output = roulement(&["import", &scratch.path("refused.rexs")]);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

fn equilibrium(scratch: &Scratch, machine: &str) -> Value {
    std::fs::write(scratch.path("machine.toml"), machine).unwrap();
    let output = roulement(&["equilibrium", &scratch.path("machine.toml"), "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// \[N] force on the shaft of a bearing: of one of balls, or one by its stiffness or by rollers.
fn force(equilibrium: &Value, name: &str) -> [f64; 3] {
    let of = BEARINGS.iter().find_map(|kind| equilibrium[kind].get(name));
    let of = of.unwrap_or_else(|| panic!("{name}: {equilibrium}"));
    ["x", "y", "z"].map(|axis| of["force"][axis].as_f64().unwrap())
}

/// Forces on all shafts of two machines are the same; how many bearings there are.
fn same_forces(own: &Value, other: &Value) -> usize {
    let names = || BEARINGS.iter().flat_map(|kind| own[kind].as_object().unwrap().keys());
    for name in names() {
        for (own, other) in force(own, name).into_iter().zip(force(other, name)) {
            assert!((own - other).abs() < 1e-6 * (1.0 + own.abs()), "{name}: {own} {other}");
        }
    }
    names().count()
}

#[test]
fn invariant_both_forms_of_a_gearbox_are_one_machine() {
    let scratch = Scratch::new("rexs-forms");
    let (old, _) = imported(&scratch, "old.rexs", OLD.as_bytes());
    let (new, _) = imported(&scratch, "new.rexsj", NEW.as_bytes());
    // Old programs write Latin 1; archives have either form.
    let latin: Vec<u8> = OLD.chars().map(|char| u8::try_from(u32::from(char)).unwrap()).collect();
    assert_eq!(imported(&scratch, "old.rexs", &latin).0, old);
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(vec![]));
    archive.start_file("model.rexsj", zip::write::SimpleFileOptions::default()).unwrap();
    archive.write_all(NEW.as_bytes()).unwrap();
    assert_eq!(imported(&scratch, "new.rexsj", &archive.finish().unwrap().into_inner()).0, new);
    // Where cones are cut does not depend on the end that they are counted from.
    assert_eq!(same_forces(&equilibrium(&scratch, &old), &equilibrium(&scratch, &new)), 4);
}

#[test]
fn closed_form_forces_of_an_imported_gearbox() {
    let scratch = Scratch::new("rexs-forces");
    let (text, told) = imported(&scratch, "gearbox.rexs", OLD.as_bytes());
    // 20 N m at 20 teeth of 2 mm and 15 degrees, against 40: what drives and what is left.
    assert!(text.contains("torque = \"40 N m\"") && text.contains("speed = \"1500 rpm\""), "{text}");
    let found = equilibrium(&scratch, &text);
    let axial = 20.0 / (0.04 / 15_f64.to_radians().cos() / 2.0) * 15_f64.to_radians().tan();
    let held = |name: &str| force(&found, name)[0];
    assert!((held("Lager-6205-2RS1") + axial).abs() < 1e-3 * axial, "{axial} {found}");
    assert!((held("Lager-6206") - axial).abs() < 1e-3 * axial);
    assert!(held("Lager-6205").abs() < 1e-3 && held("Lager-6206-53").abs() < 1e-3);
    // What no machine has is told of and stands in the file.
    for what in ["not simulated: feather key connection (70)", "cones"] {
        assert!(told.contains(what) && text.contains(what), "{what}: {told}");
    }
}

#[test]
fn closed_form_a_spectrum_is_the_duty() {
    let scratch = Scratch::new("rexs-duty");
    let (text, told) = imported(&scratch, "gearbox.rexsj", NEW.as_bytes());
    let machine: toml::Table = text.parse().unwrap();
    let duty = machine["duty"].as_array().unwrap();
    assert_eq!(duty.len(), 2);
    let share = |of: &toml::Value| of["share"].as_float().unwrap();
    assert_eq!((share(&duty[0]), share(&duty[1])), (0.25, 0.75));
    // The first case is what the file itself has; the second has 8 N m at 900 rpm, twice that at the output, and another belt.
    assert!(duty[0].get("set").is_none(), "{text}");
    let set = duty[1]["set"].as_table().unwrap();
    assert_eq!(set["shaft.Eingangswelle.speed"].as_str(), Some("900 rpm"));
    assert_eq!(set["shaft.Welle-fuer-Abtrieb.torque"].as_str(), Some("16 N m"));
    // Oil of 100 mm2/s at 40 degC where the file's casing is, of 11 at 100 where that of this case is; 880 kg/m3 at 15 degC, less by 6.4e-4 of it a kelvin.
    let millipascal = |kinematic: f64, temperature: f64| {
        kinematic * 1e-6 * 880.0 * (1.0 - 6.4e-4 * (temperature - 15.0)) * 1e3
    };
    let viscosity = |text: &str| -> f64 { text.trim_end_matches(" mPa s").parse().unwrap() };
    let own = machine["bearing"][0]["set"]["film"]["viscosity"].as_str().unwrap();
    assert!((viscosity(own) / millipascal(100.0, 40.0) - 1.0).abs() < 1e-4, "{own}");
    let hot = set["bearing.Lager-6205.set.film.viscosity"].as_str().unwrap();
    assert!((viscosity(hot) / millipascal(11.0, 100.0) - 1.0).abs() < 1e-4, "{hot}");
    // A clearance of the file stands in place of the catalogue's; what a load case has and no duty is told of.
    assert_eq!(machine["bearing"][0]["set"]["bearing"]["diametral_clearance"].as_str(), Some("0.012 mm"));
    assert!(told.contains("load cases: gear_shift_index of gear_unit is not read"), "{told}");
    let belt = set["shaft.Welle-fuer-Abtrieb.load.Last.force"].as_array().unwrap();
    assert_eq!(belt[1].as_str(), Some("100 N"));
    std::fs::write(scratch.path("machine.toml"), &text).unwrap();
    let output = roulement(&["rating", &scratch.path("machine.toml")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().filter(|line| line.starts_with("case-2,")).count(), 5, "{text}");
}

#[test]
fn invariant_a_machine_comes_back_as_it_went_out() {
    let scratch = Scratch::new("rexs-back");
    let example = format!("{}/../examples/gearbox/three_stage.toml", env!("CARGO_MANIFEST_DIR"));
    let spectrum = scratch.path("spectrum.toml");
    std::fs::write(&spectrum, imported(&scratch, "new.rexsj", NEW.as_bytes()).0).unwrap();
    for machine in [&example, &spectrum] {
        let once = roulement(&["export", machine, "-o", &scratch.path("once.rexs")]);
        let told = String::from_utf8_lossy(&once.stderr).into_owned();
        assert!(once.status.success() && told.contains("not written: shaft.retardation_time"), "{told}");
        assert_eq!(told.contains("not written: bearing.set.film"), machine == &spectrum, "{told}");
        let (text, _) = imported(&scratch, "again.rexs", &std::fs::read(scratch.path("once.rexs")).unwrap());
        std::fs::write(scratch.path("again.toml"), &text).unwrap();
        let again = roulement(&["export", &scratch.path("again.toml"), "-o", &scratch.path("twice.rexs")]);
        assert!(again.status.success(), "{}", String::from_utf8_lossy(&again.stderr));
        let [once, twice] =
            ["once.rexs", "twice.rexs"].map(|name| std::fs::read_to_string(scratch.path(name)).unwrap());
        assert_eq!(once, twice, "{machine}");
        let own = equilibrium(&scratch, &std::fs::read_to_string(machine).unwrap());
        assert!(same_forces(&own, &equilibrium(&scratch, &text)) >= 4);
    }
}

/// The old file with a pair of tapered bearings on its second shaft: one by its type and designation, one as a concept whose name is all that it has.
fn with_tapered_bearings() -> String {
    let (before, after) = OLD.split_once("<component id=\"52\"").unwrap();
    let (first, second) = after.split_once("<component id=\"53\"").unwrap();
    let first = first
        .replace("6206", "33006")
        .replace("radial_grooved_ball_bearing", "radial_tapered_roller_bearing")
        .replace("both_directions", "negative");
    let (second, rest) = second.split_once("</component>").unwrap();
    let second = second
        .replace(
            "name=\"Lager 6206 [53]\" type=\"rolling_bearing_with_catalog_geometry\"",
            "name=\"to choose: 30206 [53]\" type=\"concept_bearing\"",
        )
        .replace("<attribute id=\"name\" unit=\"none\">6206</attribute>", "")
        .replace("<attribute id=\"bearing_type\" unit=\"none\">radial_grooved_ball_bearing</attribute>", "")
        .replace("no_direction", "positive");
    format!("{before}<component id=\"52\"{first}<component id=\"53\"{second}</component>{rest}")
}

#[test]
fn closed_form_tapered_bearings_of_a_file_hold_the_shaft_each_its_way() {
    let scratch = Scratch::new("rexs-tapered");
    let (text, told) = imported(&scratch, "gearbox.rexs", with_tapered_bearings().as_bytes());
    let machine: toml::Table = text.parse().unwrap();
    let bearings = machine["bearing"].as_array().unwrap();
    let of = |name: &str| {
        bearings.iter().find(|of| of.get("catalogue").is_some_and(|of| of.as_str() == Some(name))).unwrap()
    };
    let direction =
        |name: &str| of(name)["mounting"].get("direction").map(|of| of.as_str().unwrap().to_owned());
    assert_eq!((direction("33006").as_deref(), direction("30206")), (Some("-x"), None), "{text}");
    assert!(
        told.contains("to choose: 30206") && told.contains("simulated as the 30206 of its name"),
        "{told}"
    );
    assert!(!told.contains("Lager 6206"), "{told}");
    // The casing's oil is theirs, too.
    for name in ["33006", "30206"] {
        let oil = of(name)["set"]["rollers"]["film"]["viscosity"].as_str().unwrap();
        assert_eq!(oil, bearings[0]["set"]["film"]["viscosity"].as_str().unwrap());
    }
    // The thrust of the teeth goes to the one that takes it; the other presses as much back as it is pushed by its own radial load.
    let found = equilibrium(&scratch, &text);
    let axial = 20.0 / (0.04 / 15_f64.to_radians().cos() / 2.0) * 15_f64.to_radians().tan();
    let names = ["33006", "30206"].map(|name| of(name)["name"].as_str().unwrap().to_owned());
    let held = names.each_ref().map(|name| force(&found, name)[0]);
    assert!((held[0] + held[1] - axial).abs() < 1e-3 * axial, "{held:?} {axial}");
    assert!(held[0] > 0.0 && held[1] < 0.0, "{held:?}");
    // There and back.
    std::fs::write(scratch.path("machine.toml"), &text).unwrap();
    let output = roulement(&["export", &scratch.path("machine.toml"), "-o", &scratch.path("back.rexs")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let back = imported(&scratch, "back-again.rexs", &std::fs::read(scratch.path("back.rexs")).unwrap()).0;
    assert!(back.contains("direction = \"-x\"") && back.contains("catalogue = \"33006\""), "{back}");
    assert_eq!(same_forces(&found, &equilibrium(&scratch, &back)), 4);
}

#[test]
fn consistency_a_double_row_bearing_of_a_file_is_both_rows() {
    let scratch = Scratch::new("rexs-double");
    let (before, after) = OLD.split_once("<component id=\"52\"").unwrap();
    let (own, rest) = after.split_once("</component>").unwrap();
    let own =
        own.replace("6206", "3206 A").replace("radial_grooved_ball_bearing", "angular_contact_ball_bearing");
    let rows = "<attribute id=\"number_of_bearing_rows\" unit=\"none\">2</attribute>";
    let (tag, attributes) = own.split_once('>').unwrap();
    let file = format!("{before}<component id=\"52\"{tag}>{rows}{attributes}</component>{rest}");
    let (text, told) = imported(&scratch, "gearbox.rexs", file.as_bytes());
    assert!(text.contains("catalogue = \"3206 A\"") && !told.contains("3206"), "{text}\n{told}");
    // What it carries is shared by both.
    let found = equilibrium(&scratch, &text);
    let name = text.parse::<toml::Table>().unwrap()["bearing"].as_array().unwrap().iter().find_map(|of| {
        let own = of.get("catalogue")?.as_str()? == "3206 A";
        own.then(|| of["name"].as_str().unwrap().to_owned())
    });
    let name = name.unwrap();
    let [one, other] = ["-1", "-2"].map(|row| force(&found, &format!("{name}{row}")));
    assert!(one[1].hypot(one[2]) > 10.0 && other[1].hypot(other[2]) > 10.0, "{one:?} {other:?}");
}

#[test]
fn invariant_rollers_between_two_shafts_go_there_and_back() {
    let scratch = Scratch::new("rexs-between");
    let text = include_str!("../../../scenes/shafts/idler.toml");
    std::fs::write(scratch.path("idler.toml"), text).unwrap();
    let output = roulement(&["export", &scratch.path("idler.toml"), "-o", &scratch.path("idler.rexs")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (back, told) = imported(&scratch, "again.rexs", &std::fs::read(scratch.path("idler.rexs")).unwrap());
    for name in ["K 30x35x27", "NUP 206"] {
        assert!(back.contains(&format!("catalogue = \"{name}\"")), "{back}\n{told}");
    }
    assert_eq!(back.matches("outer_shaft = \"gear\"").count(), 2, "{back}");
    assert_eq!(same_forces(&equilibrium(&scratch, text), &equilibrium(&scratch, &back)), 4);
}

#[test]
fn refusals_name_component_attribute_and_value() {
    let scratch = Scratch::new("rexs-refused");
    let changed = |from: &str, to: &str| {
        assert!(OLD.contains(from), "{from}");
        OLD.replacen(from, to, 1).into_bytes()
    };
    let cases: [(Vec<u8>, &[&str]); 9] = [
        (b"title = \"a scene\"\n".to_vec(), &["no REXS file"]),
        (OLD.as_bytes()[..OLD.len() / 2].to_vec(), &["as XML"]),
        (NEW.as_bytes()[..NEW.len() / 2].to_vec(), &["as JSON"]),
        (changed("version=\"1.0\">", "version=\"2.0.0\">"), &["version \"2.0.0\"", "1.0 to 1.7"]),
        (
            changed("id=\"normal_module\" unit=\"mm\"", "id=\"normal_module\" unit=\"furlong\""),
            &["cylindrical_gear 30", "normal_module", "furlong"],
        ),
        (changed(">1500.0<", ">NaN<"), &["shaft 3", "rotational_speed", "NaN"]),
        (changed("id=\"face_width\"", "id=\"width\""), &["cylindrical_gear 30", "face_width is missing"]),
        (
            changed(
                "<c>1</c><c>0</c><c>0</c></array></attribute>\n      <attribute id=\"w_axis_vector\" unit=\"mm\"><array><c>0</c><c>0</c><c>1</c></array></attribute>\n      <attribute id=\"reference_component_for_position\" unit=\"none\">1</attribute>\n      <attribute id=\"defines_speed\"",
                "<c>0</c><c>1</c><c>0</c></array></attribute>\n      <attribute id=\"w_axis_vector\" unit=\"mm\"><array><c>0</c><c>0</c><c>1</c></array></attribute>\n      <attribute id=\"reference_component_for_position\" unit=\"none\">1</attribute>\n      <attribute id=\"defines_speed\"",
            ),
            &["shaft 4", "90.0000 deg", "parallel"],
        ),
        (changed("<c>62.116", "<c>72.116"), &["the machine was written, and is refused", "mesh"]),
    ];
    for (bytes, words) in cases {
        let told = refusal(&scratch, &bytes);
        for word in words {
            assert!(told.contains(word), "{word}: {told}");
        }
    }
    let pinion = roulement(&["export", &scene("shafts/pinion")]);
    assert!(!pinion.status.success());
    assert!(String::from_utf8_lossy(&pinion.stderr).contains("no beams"));
}
