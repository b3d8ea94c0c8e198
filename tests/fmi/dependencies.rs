//! Dependencies that a package lists, against derivatives and values of every output by every input: at the start, at a
//! communication point and over a step

use std::collections::BTreeSet;

use roulement::fmi::v2::Status;
use roulement::interface::model_description::{all, render};
use roulement::interface::variables::{Causality, InputKind};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::fmi2_abi::*;
use crate::scenes::scene;

const STEP: f64 = 1e-4;
const THRUST: &str = include_str!("../../scenes/thrust.toml");
const HINGE: [(&str, &str); 3] =
    [("outer.drive", "\"hinge\""), ("outer.mass", "0.3"), ("outer.inertia", "[3e-4, 2e-4, 2e-4]")];

/// Races that are moved in all ways, and effects with inputs of their own. Nothing but counts is the same whatever the inputs
/// in the first two.
fn cases() -> Vec<(&'static str, Scene)> {
    vec![
        ("thrust", scene(THRUST, &[])),
        ("misalignment", scene(include_str!("../../scenes/misalignment.toml"), &[])),
        ("hinge", scene(THRUST, &HINGE)),
        ("both", scene(THRUST, &[("outer.drive", "\"pose\"")])),
        ("cage", scene(include_str!("../../scenes/cage.toml"), &[])),
        ("fits", scene(include_str!("../../scenes/effects/fits.toml"), &[])),
        ("oil", scene(include_str!("../../scenes/effects/loss_of_lubrication.toml"), &[])),
        ("planet", scene(include_str!("../../scenes/effects/planet_carrier.toml"), &[])),
    ]
}

/// A package with its lists: what each output depends on after a step, and at the start; nothing where all.
struct Listed {
    package: Package,
    step: Vec<(u32, Option<BTreeSet<u32>>)>,
    start: Vec<(u32, Option<BTreeSet<u32>>)>,
}

impl Listed {
    fn new(name: &str, case: &Scene, dependencies: Option<&str>) -> Self {
        let quoted = dependencies.map(|meaning| format!("\"{meaning}\""));
        let changes = quoted.iter().map(|meaning| ("interface.dependencies", meaning.as_str()));
        let text = Scene::edited(&case.source, changes).unwrap().source;
        let package = Package::new(&format!("dependencies-{name}"), &text);
        let xml =
            render(&Simulation::new(&Scene::parse(&text).unwrap()).unwrap(), "bearing", &all).unwrap().xml;
        let [step, start] = ["Outputs", "InitialUnknowns"].map(|element| lists(&xml, element));
        let outputs: Vec<u32> = package.references(Causality::Output);
        for list in [&step, &start] {
            assert!(list.iter().map(|(output, _)| *output).eq(outputs.iter().copied()), "{name}");
        }
        Self { package, step, start }
    }

    fn name(&self, reference: u32) -> &str {
        &self.package.rows[reference as usize].name
    }

    /// Runs some steps with all inputs set, so that none is played, and races that are shifted, tilted and loaded askew.
    fn run(&self) -> Component {
        let c = self.package.start();
        for (place, &input) in self.package.references(Causality::Input).iter().enumerate() {
            let row = &self.package.rows[input as usize];
            let part = 1.0 + 0.1 * place as f64;
            let change = match row.input_kind() {
                Some(InputKind::Displacement) => 5e-7 * part,
                Some(InputKind::Angle) => 5e-5 * part,
                Some(InputKind::Force | InputKind::Moment) => 1e-2 * part * row.nominal,
                _ => 0.0,
            };
            set(c, input, real(c, input) + change);
        }
        for k in 0..4 {
            assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
        }
        c
    }

    /// Derivatives of all outputs by an input.
    fn derivatives(&self, c: Component, input: u32) -> Vec<f64> {
        let outputs = self.package.references(Causality::Output);
        let mut values = vec![f64::NAN; outputs.len()];
        let (n, results) = (outputs.len(), values.as_mut_ptr());
        let status =
            unsafe { fmi2GetDirectionalDerivative(c, outputs.as_ptr(), n, &input, 1, &1.0, results) };
        assert_eq!(status, Status::Ok);
        values
    }

    /// Outputs and inputs whose derivatives are not zero.
    fn pattern(&self, c: Component) -> BTreeSet<(u32, u32)> {
        let outputs = self.package.references(Causality::Output);
        let mut pattern = BTreeSet::new();
        for input in self.package.references(Causality::Input) {
            let by_input = self.derivatives(c, input);
            let not_zero = outputs.iter().zip(by_input).filter(|(_, derivative)| *derivative != 0.0);
            pattern.extend(not_zero.map(|(output, _)| (*output, input)));
        }
        pattern
    }

    /// The pairs that lists allow.
    fn allowed(&self, lists: &[(u32, Option<BTreeSet<u32>>)]) -> BTreeSet<(u32, u32)> {
        let inputs = self.package.references(Causality::Input);
        let of = |(output, list): &(u32, Option<BTreeSet<u32>>)| {
            let known = inputs.iter().filter(|input| list.as_ref().is_none_or(|list| list.contains(input)));
            known.map(|input| (*output, *input)).collect::<Vec<_>>()
        };
        lists.iter().flat_map(of).collect()
    }

    fn names(&self, pairs: impl IntoIterator<Item = (u32, u32)>) -> Vec<(&str, &str)> {
        pairs.into_iter().map(|(output, input)| (self.name(output), self.name(input))).collect()
    }
}

/// Outputs of a list of unknowns with their dependencies, as value references: indices count from 1.
fn lists(xml: &str, element: &str) -> Vec<(u32, Option<BTreeSet<u32>>)> {
    let inner = xml.split_once(&format!("<{element}>")).unwrap().1;
    let inner = inner.split_once(&format!("</{element}>")).unwrap().0;
    let reference = |index: &str| index.parse::<u32>().unwrap() - 1;
    let unknown = |text: &str| {
        let attribute = |name: &str| {
            let value = text.split_once(&format!("{name}=\""))?.1;
            Some(value.split_once('"').unwrap().0)
        };
        let dependencies = attribute("dependencies");
        let known = dependencies.map(|list| list.split_whitespace().map(reference).collect());
        (reference(attribute("index").unwrap()), known)
    };
    inner.split("<Unknown ").skip(1).map(|text| unknown(text.split_once("/>").unwrap().0)).collect()
}

fn set(c: Component, input: u32, value: f64) {
    assert_eq!(unsafe { fmi2SetReal(c, &input, 1, &value) }, Status::Ok);
}

#[test]
fn invariant_derivatives_of_a_step_are_zero_where_the_step_lists_no_dependency() {
    let mut left_out = 0;
    for (name, case) in cases() {
        let listed = Listed::new(name, &case, Some("step"));
        let c = listed.run();
        let (allowed, pattern) = (listed.allowed(&listed.step), listed.pattern(c));
        unsafe { fmi2FreeInstance(c) };
        let beyond = listed.names(pattern.difference(&allowed).copied());
        assert!(beyond.is_empty(), "{name}: not listed, but not zero: {beyond:?}");
        // Lists stand for themselves: some importers take none for no dependency.
        assert!(listed.step.iter().all(|(_, list)| list.is_some()), "{name}");
        let inputs = listed.package.references(Causality::Input).len();
        left_out += listed.step.len() * inputs - allowed.len();
        if ["thrust", "misalignment"].contains(&name) {
            let zero = listed.names(allowed.difference(&pattern).copied());
            // A count and a step of a ladder change in jumps.
            let in_jumps = ["balls.loaded", "margin.step"];
            assert!(
                zero.iter().all(|(output, _)| in_jumps.contains(output)),
                "{name}: listed, but zero: {zero:?}"
            );
            assert_eq!(zero.len(), in_jumps.len() * inputs, "{name}");
        }
    }
    // Not an empty statement: races turn by their speeds alone.
    assert!(left_out > 30, "{left_out}");
}

#[test]
fn invariant_outputs_at_a_communication_point_follow_no_input_before_the_next_step() {
    for (name, case) in cases() {
        let listed = Listed::new(name, &case, None);
        assert!(listed.allowed(&listed.step).is_empty(), "{name}");
        let c = listed.run();
        let outputs = listed.package.references(Causality::Output);
        let bits = || outputs.iter().map(|output| real(c, *output).to_bits()).collect::<Vec<_>>();
        let before = bits();
        for input in listed.package.references(Causality::Input) {
            let value = real(c, input);
            set(c, input, value + 0.01 * listed.package.rows[input as usize].nominal);
            assert!(bits() == before, "{name} {}", listed.name(input));
            set(c, input, value);
        }
        unsafe { fmi2FreeInstance(c) };
    }
}

#[test]
fn invariant_derivatives_at_the_start_are_zero_where_no_dependency_is_listed() {
    for (name, case) in cases() {
        let listed = Listed::new(name, &case, Some("step"));
        let c = listed.package.instantiate();
        unsafe {
            assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
            assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        }
        let (allowed, pattern) = (listed.allowed(&listed.start), listed.pattern(c));
        let beyond = listed.names(pattern.difference(&allowed).copied());
        assert!(beyond.is_empty(), "{name}: not listed, but not zero: {beyond:?}");
        assert!(!pattern.is_empty(), "{name}");
        // What is counted from the start is 0 there.
        let counted: Vec<u32> =
            listed.start.iter().filter(|(_, list)| list.is_some()).map(|(output, _)| *output).collect();
        assert!(counted.len() >= 2, "{name}");
        assert!(counted.iter().all(|output| real(c, *output) == 0.0), "{name}");
        unsafe { fmi2FreeInstance(c) };
    }
}
