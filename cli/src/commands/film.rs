//! `roulement contact --film`: the oil film of a scene's contact over load, speed and slip.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use roulement::effects::rating::standard::STATIC_PRESSURE;
use roulement::model::bodies::Race;
use roulement::scene::units::{Force, Quantity, Velocity};
use roulement_cli::film::figure::{self, Curve};
use roulement_cli::film::{FilmContact, FilmPoint, Rolling, columns};

use super::{load, say, tell};

/// Slide-to-roll ratios of a traction curve where none are given, and speeds of a curve over the speed.
const POINTS: u32 = 41;
/// [-] ends of the slide-to-roll ratios where none are given.
const SLIPS: [f64; 2] = [1e-5, 0.3];
/// [-] how far curves over the speed go beyond the speeds that are asked for.
const BEYOND: f64 = 4.0;
/// [-] largest slide-to-roll ratio: one surface stands.
const LARGEST: f64 = 2.0;

/// Options of `roulement contact --film`.
#[derive(Args)]
pub struct Options {
    /// Scene with oil: writes film thickness, film ratio, traction, rolling resistance and drag of one of its contacts.
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["cases", "law", "degree", "grid", "exact"], requires = "loads", requires = "speeds")]
    film: Option<PathBuf>,
    /// With `--film`: the bearing, by its name, of a shaft with several.
    #[arg(long, requires = "film")]
    bearing: Option<String>,
    /// With `--film`: the race that the ball rolls on.
    #[arg(long, value_enum, default_value = "inner", requires = "film")]
    race: RaceChoice,
    /// With `--film`: normal loads, such as `100 N,1.5 kN`.
    #[arg(long, value_delimiter = ',', requires = "film")]
    loads: Vec<Positive<Force>>,
    /// With `--film`: rolling speeds, the mean of both surfaces against the contact, such as `2 m/s,10 m/s`.
    #[arg(long, value_delimiter = ',', requires = "film")]
    speeds: Vec<Positive<Velocity>>,
    /// With `--film`: slide-to-roll ratios, slip over rolling speed; 41 from 1e-5 to 0.3 if not given.
    #[arg(long, value_delimiter = ',', requires = "film")]
    slips: Vec<Slip>,
    /// With `--film`: folder for `film.csv` and `film.svg`.
    #[arg(short, long, default_value = "film", requires = "film")]
    output: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum RaceChoice {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
}

/// A number above 0, or a text with a unit.
#[derive(Clone, Copy)]
struct Positive<Q> {
    value: f64,
    of: std::marker::PhantomData<Q>,
}

impl<Q: Quantity> FromStr for Positive<Q> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let value = text.trim().parse().or_else(|_| Q::DIMENSION.parse(text.trim()))?;
        if value > 0.0 && f64::is_finite(value) {
            Ok(Self { value, of: std::marker::PhantomData })
        } else {
            Err(format!("{text} is out of range: a number above 0"))
        }
    }
}

/// A slide-to-roll ratio.
#[derive(Clone, Copy)]
struct Slip(f64);

impl FromStr for Slip {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || format!("{text} is out of range: a slide-to-roll ratio in (0, {LARGEST}]");
        let value: f64 = text.trim().parse().map_err(|_| wanted())?;
        if value > 0.0 && value <= LARGEST { Ok(Self(value)) } else { Err(wanted()) }
    }
}

/// Writes table and figure.
///
/// # Errors
/// If the scene has no oil, or a file cannot be written.
pub fn run(options: &Options) -> Result<ExitCode, Box<dyn Error>> {
    let path = options.film.as_ref().ok_or("give a table of contacts, or --film with a scene")?;
    let machine = load(path)?;
    let index = super::field::bearing(&machine, options.bearing.as_deref())?;
    let (name, scene) = machine.bearings()[index];
    let of_bearing = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
    let race = match options.race {
        RaceChoice::Inner => Race::Inner,
        RaceChoice::Outer => Race::Outer,
    };
    let contact =
        FilmContact::new(scene, race).map_err(|why| format!("{}: {of_bearing}{why}", path.display()))?;
    let loads: Vec<f64> = options.loads.iter().map(|load| load.value).collect();
    let speeds: Vec<f64> = options.speeds.iter().map(|speed| speed.value).collect();
    let slips: Vec<f64> = match options.slips.is_empty() {
        true => logarithmic(SLIPS).collect(),
        false => options.slips.iter().map(|slip| slip.0).collect(),
    };
    let mut over_slip = vec![];
    for &load in &loads {
        for &speed in &speeds {
            let at =
                |slide_to_roll: &f64| contact.at(&Rolling { load, speed, slide_to_roll: *slide_to_roll });
            let points = slips.iter().map(at).collect::<Result<Vec<FilmPoint>, _>>()?;
            over_slip.push(Curve { name: format!("{load} N, {speed} m/s"), points });
        }
    }
    let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min) / BEYOND;
    let fastest = speeds.iter().copied().fold(0.0, f64::max) * BEYOND;
    let mut over_speed = vec![];
    for &load in &loads {
        let at = |speed| contact.at(&Rolling { load, speed, slide_to_roll: 0.0 });
        let points = logarithmic([slowest, fastest]).map(at).collect::<Result<Vec<_>, _>>()?;
        over_speed.push(Curve { name: format!("{load} N"), points });
    }
    let largest =
        over_slip.iter().flat_map(|curve| &curve.points).map(|point| point.peak_pressure).fold(0.0, f64::max);
    tell((largest > STATIC_PRESSURE).then(|| {
        format!(
            "warning: {:.2} GPa of pressure is beyond what steel stands without a mark ({:.1} GPa, ISO 76)",
            1e-9 * largest,
            1e-9 * STATIC_PRESSURE
        )
    }));
    std::fs::create_dir_all(&options.output)
        .map_err(|why| format!("cannot make {}: {why}", options.output.display()))?;
    let (table, picture) = (options.output.join("film.csv"), options.output.join("film.svg"));
    let cannot_write = |why: csv::Error| format!("{}: {why}", table.display());
    let mut rows = csv::Writer::from_path(&table).map_err(cannot_write)?;
    let columns = columns();
    rows.write_record(columns.iter().map(|(name, _)| name)).map_err(cannot_write)?;
    for point in over_slip.iter().flat_map(|curve| &curve.points) {
        let cells =
            columns.iter().map(|(_, get)| get(point).map_or(String::new(), |value| value.to_string()));
        rows.write_record(cells).map_err(cannot_write)?;
    }
    rows.flush().map_err(|why| cannot_write(why.into()))?;
    let title = if scene.title.is_empty() { "contact" } else { &scene.title };
    figure::write(
        &picture,
        &format!("{of_bearing}{title}: film on the {} race", race.name()),
        &over_slip,
        &over_speed,
    )?;
    say(&format!("{}\n{}\n", table.display(), picture.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// Numbers between two ends, each the same times the one before.
fn logarithmic([low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..POINTS).map(move |k| low * (high / low).powf(f64::from(k) / f64::from(POINTS - 1)))
}
