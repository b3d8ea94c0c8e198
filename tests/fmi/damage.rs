//! Damaged balls of a package, through the C interface: their orientations are in its states.

use std::ptr;

use roulement::fmi::v2::Status;
use roulement::interface::variables::{Causality, Kind};
use roulement::scene::Scene;

use crate::fmi2_abi::*;

const STEP: f64 = 5e-5;

/// Bits of all real outputs, and of the frequency of the damaged ball, after each of some steps.
fn go_on(package: &Package, c: Component, steps: std::ops::Range<u32>) -> Vec<u64> {
    let real_one = |reference: &u32| package.rows[*reference as usize].kind == Kind::Real;
    let reals: Vec<u32> = package.references(Causality::Output).into_iter().filter(real_one).collect();
    let mut bits = vec![];
    for k in steps {
        assert_eq!(unsafe { fmi2DoStep(c, f64::from(k) * STEP, STEP, 0) }, Status::Ok);
        bits.extend(reals.iter().map(|&reference| real(c, reference).to_bits()));
    }
    bits
}

#[test]
fn invariant_a_serialised_state_of_damaged_balls_goes_on_to_the_same_bits() {
    let of = |ball: u32| {
        let spalls = format!(
            "[{{ on = \"ball\", ball = {ball}, azimuth = 0.3, length = \"1 mm\", width = \"3 mm\", depth = \"0.1 mm\" }}]"
        );
        Scene::edited(&scene_text("wrench"), [("defect", spalls)]).unwrap().source
    };
    let package = Package::new("damage", &of(2));
    let c = package.start();
    go_on(&package, c, 0..10);
    let bytes = state_bytes(c);
    let after = go_on(&package, c, 10..40);
    let other = package.start();
    let mut state = ptr::null_mut();
    unsafe {
        assert_eq!(fmi2DeSerializeFMUstate(other, bytes.as_ptr(), bytes.len(), &mut state), Status::Ok);
        assert_eq!(fmi2SetFMUstate(other, state), Status::Ok);
    }
    assert_eq!(go_on(&package, other, 10..40), after);
    // A spall of another ball is met at another time.
    let elsewhere = Package::new("damage-elsewhere", &of(3));
    let c_elsewhere = elsewhere.start();
    go_on(&elsewhere, c_elsewhere, 0..10);
    assert_ne!(go_on(&elsewhere, c_elsewhere, 10..40), after);
    unsafe {
        assert_eq!(fmi2FreeFMUstate(other, &mut state), Status::Ok);
        [c, other, c_elsewhere].into_iter().for_each(|c| fmi2FreeInstance(c));
    }
}
