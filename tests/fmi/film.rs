//! Oil of a package, as its master takes it away through the C interface.

use roulement::fmi::v2::Status;
use roulement::scene::Scene;

use crate::fmi2_abi::*;

fn thrust(changes: &[(&str, &str)]) -> String {
    Scene::edited(include_str!("../../scenes/thrust.toml"), changes.iter().copied()).unwrap().source
}

#[test]
fn identity_a_master_that_takes_the_oil_away_has_the_dry_bearing() {
    let oiled = thrust(&[("film.iso_vg", "68.0"), ("film.temperature", "70.0")]);
    let packages = [Package::new("oiled", &oiled), Package::new("dry", &thrust(&[]))];
    let [c, dry] = packages.each_ref().map(Package::start);
    let [power, dry_power] = packages.each_ref().map(|package| package.reference("friction_power"));
    let lubrication = [packages[0].reference("lubrication")];
    let rolling = packages[0].reference("rolling_power.inner");
    let step = 1e-4;
    let advance = |component, k: u32| unsafe {
        assert_eq!(fmi2DoStep(component, f64::from(k) * step, step, 0), Status::Ok);
    };
    for k in 0..20 {
        advance(c, k);
        advance(dry, k);
    }
    assert!(real(c, rolling) > 0.1, "{}", real(c, rolling));
    // At full films a derivative looks to the one side that there is: less oil, less rolling resistance.
    let mut slope = [0.0];
    unsafe {
        let status = fmi2GetDirectionalDerivative(
            c,
            [rolling].as_ptr(),
            1,
            lubrication.as_ptr(),
            1,
            [1.0].as_ptr(),
            slope.as_mut_ptr(),
        );
        assert_eq!(status, Status::Ok);
    }
    assert!((slope[0] / real(c, rolling) - 1.0).abs() < 0.1, "{slope:?} {}", real(c, rolling));
    unsafe {
        // Beyond its range it is refused and changes nothing.
        assert_eq!(fmi2SetReal(c, lubrication.as_ptr(), 1, [1.0 + 1e-9].as_ptr()), Status::Ok);
        assert_eq!(fmi2DoStep(c, 20.0 * step, step, 0), Status::Error);
        fmi2FreeInstance(c);
    }
    let c = packages[0].start();
    unsafe { assert_eq!(fmi2SetReal(c, lubrication.as_ptr(), 1, [0.0].as_ptr()), Status::Ok) };
    for k in 0..400 {
        advance(c, k);
        if k >= 20 {
            advance(dry, k);
        }
    }
    assert_eq!(real(c, rolling), 0.0);
    // It began with the spins of the oiled bearing, and has come to those of the dry one.
    let (ours, theirs) = (real(c, power), real(dry, dry_power));
    assert!((ours / theirs - 1.0).abs() < 0.02, "{ours} {theirs}");
    unsafe {
        fmi2FreeInstance(c);
        fmi2FreeInstance(dry);
    }
}
