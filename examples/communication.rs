//! Steps the package of a scene through the C interface: `communication SCENE.toml MICROSECONDS STEPS [OUTPUT...]`, reading outputs whose
//! names begin so at each communication point. `scripts/measure communication-cost` counts the instructions.
#![allow(missing_docs, clippy::unwrap_used, unsafe_code)]

#[path = "../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;

use fmi2_abi::{Package, fmi2DoStep, fmi2FreeInstance, fmi2GetReal};
use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, Kind};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, microseconds, steps, outputs @ ..] = &arguments[..] else {
        panic!("usage: communication SCENE.toml MICROSECONDS STEPS [OUTPUT...]");
    };
    let package = Package::new("communication", &std::fs::read_to_string(scene).unwrap());
    let is_read = |name: &str| outputs.iter().any(|begin| name.starts_with(begin.as_str()));
    let rows = package.rows.iter().enumerate();
    let read = rows.filter(|(_, row)| {
        row.causality == Causality::Output && row.kind == Kind::Real && is_read(&row.name)
    });
    let read: Vec<u32> = read.map(|(reference, _)| reference as u32).collect();
    let mut values = vec![0.0; read.len()];
    let component = package.start();
    let step = microseconds.parse::<f64>().unwrap() * 1e-6;
    for point in 0..steps.parse::<u32>().unwrap() {
        // SAFETY: a live instance, and as many values as references.
        let [stepped, got] = unsafe {
            [
                fmi2DoStep(component, f64::from(point) * step, step, 0),
                fmi2GetReal(component, read.as_ptr(), read.len(), values.as_mut_ptr()),
            ]
        };
        assert_eq!([stepped, got], [Status::Ok; 2]);
    }
    println!("{} outputs", read.len());
    // SAFETY: a live instance, not used any more.
    unsafe { fmi2FreeInstance(component) };
}
