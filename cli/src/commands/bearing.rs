//! `roulement bearing`: catalogue bearings as scenes.

use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use roulement::catalogue::{Bearing, Request, SOURCE, Shelf, table};

use roulement_cli::doubt::doubt;
use roulement_cli::in_machine::machine_of;
use roulement_cli::sweep::all::threads;
use roulement_cli::sweep::setting::Setting;

use super::say;

/// Options of `roulement bearing`.
#[derive(Args)]
pub struct Options {
    /// Name as on the box, such as 6205, "SKF 6305-2RS1/C3" or 7206BECBP; or give the numbers below, which stand in place of those of the table.
    designation: Vec<String>,
    /// Bore, such as "25 mm".
    #[arg(long)]
    bore: Option<String>,
    /// Outside diameter.
    #[arg(long)]
    outside: Option<String>,
    /// Width.
    #[arg(long)]
    width: Option<String>,
    /// Basic dynamic load rating C, such as "14 kN".
    #[arg(long, alias = "c", value_name = "C")]
    dynamic_load_rating: Option<String>,
    /// Basic static load rating C0.
    #[arg(long, alias = "c0", value_name = "C0")]
    static_load_rating: Option<String>,
    /// Contact angle of an angular-contact bearing, such as "40 deg".
    #[arg(long)]
    contact_angle: Option<String>,
    /// Class of the radial clearance of a deep-groove bearing: C2, CN, C3, C4, C5.
    #[arg(long)]
    clearance: Option<String>,
    /// Means by which balls are kept apart: ideal (even spacing, without mass, play and friction), estimated (a cage of pressed steel, from
    /// the balls) or none.
    #[arg(long, value_name = "CAGE")]
    cage: Option<String>,
    /// List the balls that come near both load ratings, with their errors, and how far they and what else is estimated move life, torque and loads;
    /// write no scene.
    #[arg(long)]
    candidates: bool,
    /// Key of the scene that `--candidates` looks at, as load.y.force="2 kN"; several times.
    #[arg(long, value_name = "KEY=VALUE", requires = "candidates")]
    set: Vec<String>,
    /// Tolerance of the shaft that the scene gets as a seat, such as k6 (ISO 286-1).
    #[arg(long, value_name = "CLASS")]
    shaft_fit: Option<String>,
    /// Tolerance of the housing, such as H7; 1.5 times as wide as the bearing.
    #[arg(long, value_name = "CLASS")]
    housing_fit: Option<String>,
    /// Class of the dimensions of the rings: PN, P6, P5 (ISO 492); PN if not given.
    #[arg(long, value_name = "CLASS")]
    ring_class: Option<String>,
    /// Which of these candidates the scene has.
    #[arg(long, value_name = "N", default_value_t = 1)]
    candidate: usize,
    /// Shelf of one's own bearings, which come before the table; catalogue.toml of the current folder, if it is there, where none is given.
    #[arg(long, value_name = "FILE")]
    shelf: Option<PathBuf>,
    /// List the table of common sizes, and the shelf.
    #[arg(long)]
    list: bool,
    /// Scene file to write; standard output if not given.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

impl Options {
    fn request(&self) -> Result<Request, Box<dyn Error>> {
        let mut text = toml::Table::new();
        let name = (!self.designation.is_empty()).then(|| self.designation.join(" "));
        for (key, value) in [
            ("designation", &name),
            ("bore", &self.bore),
            ("outside", &self.outside),
            ("width", &self.width),
            ("dynamic_load_rating", &self.dynamic_load_rating),
            ("static_load_rating", &self.static_load_rating),
            ("contact_angle", &self.contact_angle),
            ("clearance", &self.clearance),
            ("cage", &self.cage),
        ] {
            let Some(value) = value else { continue };
            // A bare number is one in SI; names are texts.
            let number = value.parse().ok().filter(|_| !matches!(key, "designation" | "clearance" | "cage"));
            text.insert(key.into(), number.map_or_else(|| value.clone().into(), toml::Value::Float));
        }
        Ok(Request::parse(&text.to_string())?)
    }

    /// The machine of a bearing that a machine alone has, if it is one and not on the shelf.
    fn in_machine(&self, shelf: &Shelf) -> Option<Result<String, Box<dyn Error>>> {
        let name = self.designation.join(" ");
        if shelf.names().any(|of_shelf| of_shelf == name) {
            return None;
        }
        let machine = machine_of(&name)?;
        let Self { bore, outside, width, dynamic_load_rating, static_load_rating, .. } = self;
        let Self { contact_angle, clearance, cage, shaft_fit, housing_fit, ring_class, .. } = self;
        let given = [
            ("--bore", bore),
            ("--outside", outside),
            ("--width", width),
            ("--dynamic-load-rating", dynamic_load_rating),
            ("--static-load-rating", static_load_rating),
            ("--contact-angle", contact_angle),
            ("--clearance", clearance),
            ("--cage", cage),
            ("--shaft-fit", shaft_fit),
            ("--housing-fit", housing_fit),
            ("--ring-class", ring_class),
        ];
        let given = given.into_iter().find_map(|(option, value)| value.is_some().then_some(option));
        let other =
            (self.candidates).then_some("--candidates").or((self.candidate != 1).then_some("--candidate"));
        Some(match given.or(other) {
            Some(option) => Err(format!(
                "{option} is for a bearing of balls in one row; {name} is written as a machine, whose keys can be changed there"
            )
            .into()),
            None => machine.map_err(Into::into),
        })
    }

    /// Keys of the seats that are asked for, with their values, those of a section behind one another.
    fn fits(&self, bearing: &Bearing) -> Vec<(String, String)> {
        let metres = |length: f64| toml::Value::Float(length).to_string();
        let word = |word: &String| toml::Value::String(word.clone()).to_string();
        let class = self.ring_class.iter().map(|class| {
            let class = class.to_lowercase();
            ("growth.ring_class", word(&if class == "pn" { "normal".into() } else { class }))
        });
        let shaft = self.shaft_fit.iter().flat_map(|fit| {
            [("growth.shaft.fit", word(fit)), ("growth.shaft.diameter", metres(bearing.bore))]
        });
        let housing = self.housing_fit.iter().flat_map(|fit| {
            [
                ("growth.housing.fit", word(fit)),
                ("growth.housing.diameter", metres(bearing.outside)),
                ("growth.housing.outside", metres(HOUSING * bearing.outside)),
            ]
        });
        class.chain(shaft).chain(housing).map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

/// [-] outside diameter of a housing over that of its bearing, where nothing is known of it.
const HOUSING: f64 = 1.5;

const NO_CHANGE: [(&str, &str); 0] = [];

/// A scene with keys of sections that it does not have.
fn with_fits(mut scene: String, fits: &[(String, String)]) -> Result<String, roulement::SceneError> {
    let mut section = "";
    for (key, value) in fits {
        let (own, name) = key.rsplit_once('.').unwrap_or_default();
        if own != section {
            scene += &format!("\n[{own}]\n");
            section = own;
        }
        scene += &format!("{name} = {value}\n");
    }
    if !fits.is_empty() {
        roulement::Scene::edited(&scene, NO_CHANGE)?;
    }
    Ok(scene)
}

/// Writes the scene, or lists what is asked for.
///
/// # Errors
/// If there is no such bearing, or the file cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let shelf = match &options.shelf {
        Some(path) => Shelf::load(path)?,
        None => Shelf::beside("".as_ref())?,
    };
    if options.list {
        return Ok(say(&list(&shelf))?);
    }
    if let Some(machine) = options.in_machine(&shelf) {
        return write(&options.output, machine?);
    }
    let bearing = options.request()?.of_shelf(&shelf)?;
    if options.candidates {
        let given = options.set.iter().map(|given| setting(given)).collect::<Result<Vec<_>, _>>()?;
        let set = [options.fits(&bearing), given].concat();
        let spread = doubt(&bearing, options.candidate, &set, threads())?;
        return Ok(say(&format!("{}\n{}", candidates(&bearing)?, spread.to_text()))?);
    }
    let scene = with_fits(bearing.scene(options.candidate)?, &options.fits(&bearing))?;
    write(&options.output, scene)
}

/// Writes a scene to a file, or says it.
fn write(output: &Option<PathBuf>, scene: String) -> Result<(), Box<dyn Error>> {
    match output {
        Some(path) => {
            std::fs::write(path, scene).map_err(|why| format!("cannot write {}: {why}", path.display()))?;
            say(&format!("{}\n", path.display()))?;
        }
        None => say(&scene)?,
    }
    Ok(())
}

/// Key and value of `KEY=VALUE`: TOML, or a text such as 2 kN.
fn setting(given: &str) -> Result<(String, String), String> {
    let (key, value) = given
        .split_once('=')
        .ok_or_else(|| format!("--set {given}: allowed is KEY=VALUE, such as load.y.force=\"2 kN\""))?;
    Ok((key.trim().to_owned(), Setting::of_cell(value.trim(), None).toml))
}

/// The table of common sizes.
fn list(shelf: &Shelf) -> String {
    let mut text = format!(
        "load ratings: {SOURCE}\n\n{:<12} {:>4} {:>7} {:>5} {:>9} {:>9}\n",
        "name", "bore", "outside", "width", "C [kN]", "C0 [kN]"
    );
    for row in table() {
        let (name, bore, outside, width) = (row.designation, row.bore, row.outside, row.width);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{name:<12} {bore:>4} {outside:>7} {width:>5} {:>9} {:>9}",
            row.dynamic, row.static_
        );
    }
    for name in shelf.names() {
        let _ = writeln!(text, "{name:<12} (shelf)");
    }
    text
}

/// Balls that come near both ratings.
fn candidates(bearing: &Bearing) -> Result<String, Box<dyn Error>> {
    let (dynamic, static_) = (1e-3 * bearing.dynamic_load_rating, 1e-3 * bearing.static_load_rating);
    let mut text = format!(
        "{}\nC {dynamic:.2} kN, C0 {static_:.2} kN ({})\n\n{:>2} {:>5} {:>10} {:>9} {:>8} {:>9} {:>8} {:>17}\n",
        bearing.title(),
        bearing.source,
        "",
        "balls",
        "ball [mm]",
        "C [kN]",
        "error",
        "C0 [kN]",
        "error",
        "conformities"
    );
    for (at, of) in bearing.candidates()?.iter().enumerate() {
        let [dynamic, static_] = of.errors.map(|error| 100.0 * error);
        let [inner, outer] = of.geometry.conformities;
        writeln!(
            text,
            "{:>2} {:>5} {:>10.4} {:>9.2} {dynamic:>+6.1} % {:>9.2} {static_:>+6.1} % {inner:>8} / {outer}",
            at + 1,
            of.geometry.balls,
            1e3 * of.geometry.ball_diameter,
            1e-3 * of.dynamic_load_rating,
            1e-3 * of.static_load_rating,
        )?;
    }
    Ok(text)
}
