//! Temperatures of a package, as its master sets them through the C interface.

use roulement::fmi::v2::Status;
use roulement::scene::Scene;

use crate::fmi2_abi::*;

/// A 7206 held by the displacement at which it carries 1500 N cold (T13 of tests/data/growth), at the temperature of its dimensions.
fn cold() -> String {
    let changes = [
        ("effects", "{ creep = \"frictionless\" }"),
        ("growth.inner", "0"),
        ("growth.outer", "0"),
        ("growth.balls", "0"),
        ("load.inner_speed", "\"600 rpm\""),
    ];
    Scene::edited(include_str!("../../scenes/effects/growth.toml"), changes).unwrap().source
}

#[test]
fn independent_data_a_master_warms_the_bearing_up() {
    let package = Package::new("warming", &cold());
    let c = package.start();
    let output = |name: &str| real(c, package.reference(name));
    assert!((output("inner.force.x").abs() / 1500.0 - 1.0).abs() < 1e-3, "{}", output("inner.force.x"));
    let start = output("clearance");
    let rises =
        ["inner", "outer", "balls"].map(|part| package.reference(&format!("temperature_rise.{part}")));
    let step = 1e-3;
    let mut last = output("inner.force.x").abs();
    for k in 0..60 {
        let warm = f64::from(k.min(50)) / 50.0;
        let values = [50.0, 30.0, 40.0].map(|rise| rise * warm);
        unsafe {
            assert_eq!(fmi2SetReal(c, rises.as_ptr(), 3, values.as_ptr()), Status::Ok);
            assert_eq!(fmi2DoStep(c, f64::from(k) * step, step, 0), Status::Ok);
        }
        let now = output("inner.force.x").abs();
        assert!(k > 50 || now > last - 1.0, "{k}: {last} {now}");
        last = now;
    }
    // T13 warm: loads and clearance of the independent solution.
    assert!((last / 2863.77836 - 1.0).abs() < 1e-3, "{last}");
    assert!((output("clearance") - 7.82425271234e-05).abs() < 1e-12, "{} from {start}", output("clearance"));
    // What no thermometer shows is refused and changes nothing.
    unsafe {
        let bits = output("clearance").to_bits();
        assert_eq!(fmi2SetReal(c, rises.as_ptr(), 1, &f64::NAN), Status::Error);
        assert_eq!(output("clearance").to_bits(), bits);
        fmi2FreeInstance(c);
    }
}
