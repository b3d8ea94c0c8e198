//! Arrays of packages of FMI 3.0 (`interface.arrays`): the numbers of scalars to the last bit, and what makes an array.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use roulement::fmi::v3::Status;
use roulement::interface::model_description::{Version, all, render_as};
use roulement::interface::references::{Place, References, rate_row};
use roulement::interface::terminals::terminals;
use roulement::interface::variables::{Causality, Kind, MachineVariables, Variable, Variables};
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;

use crate::fmi2_abi::*;
use crate::fmi3_abi::*;
use crate::random::Random;
use crate::scenes::scene;
use crate::system;

/// \[s] communication step: a power of two, so that sums of them are exact.
const STEP: f64 = 1.0 / 16384.0;

/// The scene with arrays.
fn with_arrays(text: &str) -> String {
    scene(text, &[("interface.arrays", "true")]).source
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Variables of a package that has arrays, as its description tells of them: arrays, and scalars that are part of none; with the scalars of each.
struct Told {
    references: References,
    all: Vec<u32>,
}

impl Told {
    fn new(package: &Package) -> Self {
        let references = References::of(&package.rows, true);
        let scalars = package.rows.len() + 1 + references.rates().count();
        let whole = references.whole_arrays(|_| true);
        let first = |one: &usize| whole[*one].is_none_or(|(_, array)| array.elements[0] as usize == *one);
        let all = (0..scalars).filter(first).map(|one| whole[one].map_or(one, |(own, _)| own) as u32);
        Self { all: all.collect(), references }
    }

    /// Those whose scalars are real rows of a causality; of rates as of inputs.
    fn of(&self, rows: &[Variable], causality: Causality) -> Vec<u32> {
        let is = |reference: &&u32| match self.references.place(self.references.scalars(reference)[0]) {
            Some(Place::Row(row)) => rows[row].causality == causality && rows[row].kind == Kind::Real,
            Some(Place::Rate(_)) => causality == Causality::Input,
            _ => false,
        };
        self.all.iter().filter(is).copied().collect()
    }

    fn scalars(&self, references: &[u32]) -> Vec<u32> {
        self.references.spread(references).into_owned()
    }
}

/// Reads variables, arrays among them, into as many values as they have.
fn get(slave: Slave, told: &Told, references: &[u32]) -> Vec<f64> {
    let mut values = vec![f64::NAN; told.references.number(references)];
    let (n, m) = (references.len(), values.len());
    let status = unsafe { fmi3GetFloat64(slave.0, references.as_ptr(), n, values.as_mut_ptr(), m) };
    assert_eq!(status, Status::Ok);
    values
}

type Product = unsafe extern "C" fn(
    Handle,
    *const u32,
    usize,
    *const u32,
    usize,
    *const f64,
    usize,
    *mut f64,
    usize,
) -> Status;

/// Derivatives by one of the two functions, with `results` numbers.
fn derivatives(
    slave: Slave,
    product: Product,
    (unknowns, knowns): (&[u32], &[u32]),
    seed: &[f64],
    results: usize,
) -> Vec<f64> {
    let mut found = vec![f64::NAN; results];
    let (u, nu, k, nk) = (unknowns.as_ptr(), unknowns.len(), knowns.as_ptr(), knowns.len());
    let status =
        unsafe { product(slave.0, u, nu, k, nk, seed.as_ptr(), seed.len(), found.as_mut_ptr(), results) };
    assert_eq!(status, Status::Ok);
    found
}

/// Runs a package without and one with arrays, with some inputs driven: value, rates and derivatives have the same bits, however they are asked for.
fn runs_alike(
    plain: &Package,
    arrayed: &Package,
    steps: u32,
    drive: impl Fn(f64) -> Vec<(&'static str, f64)>,
) {
    assert_ne!(plain.guid, arrayed.guid);
    let told = Told::new(arrayed);
    let (inputs, outputs) =
        (told.of(&arrayed.rows, Causality::Input), told.of(&arrayed.rows, Causality::Output));
    assert!(outputs.len() + 10 < told.scalars(&outputs).len(), "many outputs are elements");
    let (one, other) = (Slave::new(plain).initialise(), Slave::new(arrayed).initialise());
    let mut moved = BTreeSet::new();
    for k in 0..steps {
        let time = f64::from(k) * STEP;
        // All inputs in one call, with those that are driven changed.
        let mut values = get(other, &told, &inputs);
        let scalars = told.scalars(&inputs);
        for (name, value) in drive(time) {
            let reference = plain.reference(name);
            assert_eq!(one.set(&[reference], &[value]), Status::Ok);
            values[scalars.iter().position(|scalar| *scalar == reference).unwrap()] = value;
        }
        assert_eq!(other.set(&inputs, &values), Status::Ok);
        for slave in [one, other] {
            assert_eq!(slave.step(time, STEP).0, Status::Ok);
        }
        let (first, second) = (one.get(&told.scalars(&outputs)), get(other, &told, &outputs));
        assert_eq!(bits(&first), bits(&second), "step {k}");
        assert_eq!(bits(&one.get(&scalars)), bits(&get(other, &told, &inputs)));
        moved.insert(bits(&first));
    }
    assert_eq!(moved.len(), steps as usize, "values change from step to step");
    let (knowns, unknowns) = (told.scalars(&inputs), told.scalars(&outputs));
    let mut random = Random::new(5);
    for (product, seeds, results) in [
        (fmi3GetDirectionalDerivative as Product, knowns.len(), unknowns.len()),
        (fmi3GetAdjointDerivative as Product, unknowns.len(), knowns.len()),
    ] {
        let seed: Vec<f64> = (0..seeds).map(|_| 1e-6 * random.symmetric()).collect();
        let first = derivatives(one, product, (&unknowns, &knowns), &seed, results);
        let second = derivatives(other, product, (&outputs, &inputs), &seed, results);
        assert_eq!(bits(&first), bits(&second));
        assert!(first.iter().filter(|entry| **entry != 0.0).count() > 5);
    }
    let mut rates = [vec![f64::NAN; unknowns.len()], vec![f64::NAN; unknowns.len()]];
    for ((slave, references), rates) in [(one, &unknowns), (other, &outputs)].into_iter().zip(&mut rates) {
        let (orders, n, m) = (vec![1; references.len()], references.len(), rates.len());
        let (r, o, v) = (references.as_ptr(), orders.as_ptr(), rates.as_mut_ptr());
        assert_eq!(unsafe { fmi3GetOutputDerivatives(slave.0, r, n, o, v, m) }, Status::Ok);
    }
    assert_eq!(bits(&rates[0]), bits(&rates[1]));
    one.free();
    other.free();
}

#[test]
fn invariant_arrays_of_a_bearing_by_its_pose_have_the_bits_of_scalars() {
    for orientation in ["shaft", "quaternion"] {
        let text = scene(&pose_text(orientation), &[("effects.per_ball_outputs", "true")]).source;
        let [plain, arrayed] = [("v3-scalars", text.clone()), ("v3-arrays", with_arrays(&text))]
            .map(|(name, text)| Package::new(name, &text));
        let (size, frequency) = (2e-6, 3e3); // [m], [rad/s]
        runs_alike(&plain, &arrayed, 20, |time| {
            let (sine, cosine) = (frequency * time).sin_cos();
            vec![("inner.position.y", size * sine), ("inner.velocity.y", size * frequency * cosine)]
        });
    }
}

#[test]
fn invariant_arrays_of_a_bearing_under_a_wrench_have_the_bits_of_scalars() {
    let keys = [("effects.per_ball_outputs", "true"), ("effects.stiffness_outputs", "true")];
    let text = scene(&scene_text("wrench"), &keys).source;
    let [plain, arrayed] = [("v3-scalars-w", text.clone()), ("v3-arrays-w", with_arrays(&text))]
        .map(|(name, text)| Package::new(name, &text));
    runs_alike(&plain, &arrayed, 20, |time| {
        vec![("inner.applied_force.y", 100.0 * (2e3 * time).sin()), ("friction", 0.1 - 10.0 * time)]
    });
}

#[test]
fn invariant_arrays_of_a_shaft_have_the_bits_of_scalars() {
    let text = system::plain();
    let arrayed = format!("{text}\n[interface]\narrays = true\n");
    let [plain, arrayed] = [("v3-scalars-s", text), ("v3-arrays-s", arrayed)]
        .map(|(name, text)| Package::of_system(name, &text));
    runs_alike(&plain, &arrayed, 10, |time| vec![("mesh.force.z", 1260.5 + 1e5 * time)]);
}

#[test]
fn what_is_no_array_is_refused_and_sets_nothing() {
    let text = pose_text("shaft");
    let arrayed = Package::new("v3-arrays-refused", &with_arrays(&text));
    let plain = Package::new("v3-arrays-none", &text);
    let references = References::of(&arrayed.rows, true);
    let array = |name: &str| references.arrays().find(|(_, array)| array.name == name).unwrap().0 as u32;
    let [position, force] = ["inner.position", "inner.force"].map(array);
    let last = references.arrays().last().unwrap().0 as u32;
    let slave = Slave::new(&arrayed).initialise();
    let places = ["x", "y", "z"].map(|axis| arrayed.reference(&format!("inner.position.{axis}")));
    let before = slave.get(&places);
    for (references, values) in [
        (&[position][..], &[1e-6, 2e-6][..]),
        (&[position], &[1e-6, 2e-6, 3e-6, 4e-6]),
        (&[position], &[1e-6, f64::NAN, 3e-6]),
        // An output.
        (&[force], &[1.0, 2.0, 3.0]),
        (&[position, force], &[1e-6, 2e-6, 3e-6, 1.0, 2.0, 3.0]),
        // Behind all of them.
        (&[last + 1], &[0.0]),
    ] {
        assert_eq!(slave.set(references, values), Status::Error, "{references:?} {values:?}");
        assert_eq!(slave.get(&places), before);
    }
    assert_eq!(slave.set(&[position], &[1e-6, 2e-6, 3e-6]), Status::Ok);
    assert_eq!(slave.get(&places), [1e-6, 2e-6, 3e-6]);
    // A list that would be long beyond measure were it taken for what it says is told from its number of values.
    let many = vec![position; 1 << 20];
    let mut few = vec![0.0; 4];
    let status = unsafe { fmi3GetFloat64(slave.0, many.as_ptr(), many.len(), few.as_mut_ptr(), few.len()) };
    assert_eq!(status, Status::Error);
    slave.free();
    let slave = Slave::new(&plain).initialise();
    assert_eq!(slave.set(&[position], &[1e-6, 2e-6, 3e-6]), Status::Error, "a package without arrays");
    slave.free();
}

fn scenes() -> Vec<PathBuf> {
    fn within(folder: &Path, all: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => within(&path, all),
                false if path.extension().is_some_and(|ending| ending == "toml") => all.push(path),
                false => {}
            }
        }
    }
    let mut all = vec![];
    within(format!("{}/scenes", roulement_tests::ROOT).as_ref(), &mut all);
    all.sort();
    all
}

/// Every scalar is in one array at most, elements are alike, and names are unique. Names of arrays with their dimensions.
fn check_arrays(rows: &[Variable]) -> BTreeMap<String, Vec<usize>> {
    let references = References::of(rows, true);
    let mut elements = BTreeSet::new();
    let mut found = BTreeMap::new();
    let of_rate: BTreeMap<usize, usize> = references.rates().collect();
    let name = |reference: u32| match of_rate.get(&(reference as usize)) {
        Some(row) => rate_row(&rows[*row]).name,
        None => rows[reference as usize].name.clone(),
    };
    for (_, array) in references.arrays() {
        assert_eq!(array.dimensions.iter().product::<usize>(), array.elements.len(), "{}", array.name);
        assert!(array.elements.len() > 1 && array.dimensions.iter().all(|length| *length > 1));
        for element in &array.elements {
            assert!(elements.insert(*element), "{} is in two arrays", name(*element));
        }
        assert!(found.insert(array.name.clone(), array.dimensions.clone()).is_none(), "{}", array.name);
    }
    let scalars = (0..rows.len() as u32).chain(of_rate.keys().map(|rate| *rate as u32));
    for scalar in scalars.filter(|scalar| !elements.contains(scalar)) {
        assert!(found.insert(name(scalar), vec![]).is_none(), "{} is there twice", name(scalar));
    }
    found.retain(|_, dimensions| !dimensions.is_empty());
    found
}

#[test]
fn invariant_every_scalar_of_every_scene_is_in_one_variable() {
    let mut with_balls = 0;
    for path in scenes() {
        // Those of sweeps and of shafts are no scenes of one bearing.
        let Ok(scene) = Scene::load(&path) else { continue };
        let found = check_arrays(Variables::new(&scene).rows());
        assert_eq!(found.get("inner.force"), Some(&vec![3]), "{}", path.display());
        if scene.effects.per_ball.on {
            assert_eq!(found.get("ball.inner.load"), Some(&vec![scene.bearing.balls]), "{}", path.display());
            with_balls += 1;
        }
    }
    assert!(with_balls > 1);
    let stiffness = Scene::load(format!("{}/scenes/effects/stiffness.toml", roulement_tests::ROOT).as_ref());
    let found = check_arrays(Variables::new(&stiffness.unwrap()).rows());
    for block in ["linear.linear", "linear.angular", "angular.linear", "angular.angular"] {
        assert_eq!(found.get(&format!("stiffness.{block}")), Some(&vec![3, 3]));
    }
}

#[test]
fn descriptions_and_terminals_name_arrays() {
    let pinion = format!("{}/scenes/shafts/pinion.toml", roulement_tests::ROOT);
    for (text, count) in [
        (with_arrays(&scene(&pose_text("shaft"), &[("effects.per_ball_outputs", "true")]).source), 5),
        (format!("{}\n[interface]\narrays = true\n", std::fs::read_to_string(pinion).unwrap()), 20),
    ] {
        let machine = Machine::new(&MachineScene::parse(&text).unwrap()).unwrap();
        let variables = MachineVariables::new(&machine);
        let expected = check_arrays(variables.rows());
        let xml = render_as(&Version::V3.into(), &machine, "b", &all).unwrap().xml;
        assert_eq!(xml.matches("<Dimension ").count(), expected.values().map(Vec::len).sum::<usize>());
        assert!(expected.len() >= count, "{}", expected.len());
        for name in expected.keys() {
            assert_eq!(xml.matches(&format!("name=\"{name}\" ")).count(), 1, "{name}");
        }
        // In 2.0 there are none.
        let scalars = render_as(&Version::V2.into(), &machine, "b", &all).unwrap().xml;
        assert!(
            !scalars.contains("Dimension")
                && scalars.matches("<ScalarVariable ").count() == variables.rows().len()
        );
        let some =
            render_as(&Version::V3.into(), &machine, "b", &|name| !name.ends_with("force.y")).unwrap().xml;
        assert!(
            some.contains("inner.force.x\"")
                && !some.contains("inner.force\"")
                && !some.contains("inner.force.y\"")
        );
        let of = |arrays: bool| terminals(variables.rows(), Version::V3, arrays, &all);
        let (scalars, arrays) = (of(false), of(true));
        assert!(scalars.iter().map(|one| &one.name).eq(arrays.iter().map(|one| &one.name)));
        let members =
            |name: &str| arrays.iter().find(|one| one.name.ends_with(name)).unwrap().members.clone();
        assert!(
            members("inner").iter().any(|one| one.name == "force" && one.variable.ends_with("inner.force"))
        );
        assert!(arrays.iter().flat_map(|one| &one.members).all(|one| !one.name.ends_with(".x")));
        // Those of 2.0 have the variables of 2.0: all scalars but accelerations, whatever the scene says of arrays.
        let second = terminals(variables.rows(), Version::V2, true, &all);
        let known: BTreeSet<&str> = variables.rows().iter().map(|row| row.name.as_str()).collect();
        let mut of_both = scalars.clone();
        for terminal in &mut of_both {
            terminal.members.retain(|member| known.contains(member.variable.as_str()));
        }
        assert_eq!(second, of_both);
    }
}
