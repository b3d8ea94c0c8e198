//! Ratings and lives of roller bearings, by ISO 281, ISO 76 and ISO/TS 16281.

use nalgebra::Vector6;
use roulement::effects::rating::line_contact::Ratings;
use roulement::model::link::roller::Profile;
use roulement::model::link::rollers::{Geometry, Rollers};

#[test]
fn published_factors_of_line_contact() {
    // f_c of ISO 281: 2007, table 7.
    for (gamma, factor) in [
        (0.01, 52.1),
        (0.02, 60.8),
        (0.05, 74.1),
        (0.1, 84.2),
        (0.14, 87.7),
        (0.2, 88.7),
        (0.24, 87.5),
        (0.3, 83.8),
    ] {
        // One roller of 1 mm: C is 1.1 f_c.
        let own = Ratings::new(1, [1e-3, 1e-3, 1e-3 / gamma], 1.0, None).dynamic_load_rating / 1.1;
        println!("{gamma} {own} {factor}");
        assert!((own / factor - 1.0).abs() < 1e-3, "{gamma}: {own} {factor}");
    }
}

/// A bearing of the size of an NU 206, half of whose rollers are loaded.
fn half_loaded(profile: Profile) -> Rollers {
    let geometry = Geometry {
        count: 13,
        diameter: 9e-3,
        length: 8.8e-3,
        pitch_diameter: 46.5e-3,
        diametral_clearance: 0.0,
        profile,
        ribs: [false; 2],
        axial_clearance: 0.0,
        rib_stiffness: None,
        first_azimuth: 0.0,
        taper: None,
    };
    Rollers::new(geometry, None)
}

#[test]
fn closed_form_a_half_loaded_bearing_of_straight_rollers_has_the_life_of_iso_281_at_its_rating() {
    // The ratings of a lamina undo the factor 0.83 of C for uneven loads; edges of even lines have the factor of each lamina in its place.
    let edges = (0..30).map(|k| {
        let place = (f64::from(2 * k - 29) / 60.0).abs();
        (1.0 - 0.01 / (1.985 * place).ln()).powf(4.5) / 30.0
    });
    let factor = 0.83f64.powi(4) * edges.sum::<f64>().powf(8.0 / 9.0);
    let bearing = half_loaded(Profile::Straight);
    let still = Vector6::zeros();
    for way in [5e-6, 20e-6, 50e-6] {
        let d = Vector6::ith(1, way);
        let force = -bearing.force(&d, &still).force[1];
        let own = bearing.outputs(&d, &still, &[], None).life * factor;
        // Powers of 4 and of 10/3 agree at C.
        let standard = (bearing.ratings().dynamic_load_rating / force).powi(4);
        println!("{force} N: {own} {standard} {}", own / standard);
        assert!((own / standard - 1.0).abs() < 0.05, "{force} N: {own} {standard}");
    }
}

#[test]
fn invariant_static_safety_at_the_static_rating_and_lives_that_fall_with_load_and_tilt() {
    let bearing = half_loaded(Profile::Straight);
    let still = Vector6::zeros();
    let mut before = f64::INFINITY;
    for way in [0.0, 1e-6, 5e-6, 20e-6, 45e-6] {
        let d = Vector6::ith(2, way);
        let outputs = bearing.outputs(&d, &still, &[], None);
        assert!(outputs.life < before || way <= 1e-6, "{way}: {}", outputs.life);
        before = outputs.life;
    }
    // ISO 76: the largest load is 5 F/Z there, for clearance, where 4.08 is that of none: so C0 is 4000 MPa at 4.08/5 of it.
    let (mut low, mut high) = (1e-6, 500e-6);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let d = Vector6::ith(2, middle);
        if bearing.outputs(&d, &still, &[], None).static_safety > 1.0 { low = middle } else { high = middle }
    }
    let force = -bearing.force(&Vector6::ith(2, low), &still).force[2];
    let over = force / bearing.ratings().static_load_rating;
    assert!((over / (5.0 / 4.08) - 1.0).abs() < 0.05, "{over}");
    let tilted = Vector6::new(0.0, 20e-6, 0.0, 0.0, 0.0, 2e-3);
    let [even, uneven] = [Vector6::ith(1, 20e-6), tilted]
        .map(|d| half_loaded(Profile::Logarithmic).outputs(&d, &still, &[], None));
    assert!(
        uneven.life < 0.9 * even.life && uneven.peak_pressure > even.peak_pressure,
        "{uneven:?} {even:?}"
    );
}
