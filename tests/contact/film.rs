//! Films of oil between balls and races: single contacts against independent data (tests/data/effects/README.md) and closed forms.

use roulement::contact::film::ShearPressure;
use roulement::contact::film::mixed::MixedFriction;
use roulement::contact::film::rolling::{self, Inlet};
use roulement::contact::film::thickness::{Ellipse, inlet_factor};
use roulement::contact::film::{Film, FilmForces, Loading, Lubricant, RacewayFilm, Supply};
use roulement::contact::hertz::HertzContact;
use roulement::effects::film::oil::Oil;
use roulement::numerics::scalar::Dual;

const FILMS: &str = include_str!("../data/effects/ehl_film.csv");
const TRACTION: &str = include_str!("../data/effects/ehl_traction.csv");
const ROLLING: &str = include_str!("../data/effects/rolling_resistance.csv");

/// [Pa] E' of steel on steel.
const MODULUS: f64 = 206e9 / 0.91;
/// [1/Pa] compliance of both.
const COMPLIANCE: f64 = 2.0 / MODULUS;
/// [Pa s] viscosity of the data's oil.
const VISCOSITY: f64 = 0.0585;

/// The oil of the data.
const OIL: Lubricant = Lubricant {
    pressure_viscosity: 2.2e-8,
    temperature_viscosity: 0.035,
    conductivity: 0.14,
    eyring_stress: 6e6,
    limiting_shear: 0.08,
    shear_pressure: ShearPressure::Mean,
    roughness: 0.1e-6,
    mixed_friction: MixedFriction::OlverSpikes,
    inlet_heating: false,
    rolling_resistance: true,
};

/// Rows of a table: the race, then numbers.
fn rows(text: &str) -> impl Iterator<Item = (bool, Vec<f64>)> {
    text.lines().skip(1).map(|line| {
        let (race, numbers) = line.split_once(',').unwrap();
        (race == "inner", numbers.split(',').map(|cell| cell.parse().unwrap()).collect())
    })
}

fn close(ours: f64, theirs: f64, tolerance: f64, what: &str) {
    assert!((ours / theirs - 1.0).abs() < tolerance, "{what}: {ours} for {theirs}");
}

/// [1/m] sums of curvatures of a 6206, along and across rolling, as the data have them.
fn curvatures(inner: bool) -> [f64; 2] {
    let row = rows(FILMS).find(|row| row.0 == inner).unwrap().1;
    [row[0], row[1]]
}

/// A contact of the 6206 under a load [N], rolling [m/s], with what a test asks of its film at a slip [m/s].
fn with_contact<T>(
    inner: bool,
    load: f64,
    speed: f64,
    slip: f64,
    of: impl FnOnce(&Film<'_>, &Loading<f64>) -> T,
) -> T {
    let [along, across] = curvatures(inner);
    let hertz = HertzContact::new(along, across, COMPLIANCE);
    let root = (load / hertz.stiffness).cbrt();
    let axes = [hertz.semi_axis_rolling * root, hertz.semi_axis_transverse * root];
    let ellipse = Ellipse::new(axes, load, MODULUS, along);
    let raceway = RacewayFilm::new(OIL, MODULUS, ellipse);
    let supply = Supply { viscosity: VISCOSITY, lubrication: 1.0, replenishment: 1.0, dry_share: 0.0 };
    let area = std::f64::consts::PI * axes[0] * axes[1];
    let film = Film::new(&raceway, supply, 0.1);
    of(&film, &Loading { load, speed, slip, curvature: along, area })
}

#[test]
fn independent_data_films() {
    let mut seen = 0;
    for (inner, row) in rows(FILMS) {
        let [along, across, load, speed, pressure, ellipticity, u, g, w, central, minimum, thermal, factor] =
            row[..]
        else {
            panic!("{row:?}")
        };
        assert_eq!(curvatures(inner), [along, across]);
        // Those of the bearing: balls of 9.525 mm in the bottom of grooves of 0.52 and 0.53 on 46 mm, with a clearance of 10 um.
        let (ball, bottom) = (
            0.5 * 9.525e-3,
            if inner { 23e-3 - 2.5e-6 - 0.5 * 9.525e-3 } else { -(23e-3 + 2.5e-6 + 0.5 * 9.525e-3) },
        );
        close(1.0 / ball + 1.0 / bottom, along, 1e-10, "curvature along");
        close(
            1.0 / ball - 1.0 / (if inner { 0.52 } else { 0.53 } * 9.525e-3),
            across,
            1e-10,
            "curvature across",
        );
        close(VISCOSITY * speed * along / MODULUS, u, 1e-10, "U");
        close(OIL.pressure_viscosity * MODULUS, g, 1e-10, "G");
        close(load * along * along / MODULUS, w, 1e-10, "W");
        with_contact(inner, load, speed, 1e-3, |film, loading| {
            close(1.0 / film.raceway.ellipse.ratio, ellipticity, 1e-9, "ellipticity");
            close(1.5 * load / loading.area, pressure, 1e-9, "pressure");
            let [c, m] = film.films(loading);
            close(c, central, 1e-10, "central film");
            close(m, minimum, 1e-10, "minimum film");
        });
        close(inlet_factor(pressure / MODULUS, thermal.ln()), factor, 1e-10, "thermal factor");
        seen += 1;
    }
    assert_eq!(seen, 14);
}

#[test]
fn independent_data_traction_at_mean_pressure() {
    let (mut seen, mut near) = (0, 0);
    for (_, row) in rows(TRACTION) {
        let [load, _, ratio, slip, film, peak, viscosity, local, mean, _, slope] = row[..] else {
            panic!("{row:?}")
        };
        let pressure = 2.0 / 3.0 * peak;
        close(OIL.viscosity_under(VISCOSITY, pressure), viscosity, 1e-9, "viscosity");
        let shear = OIL.shear(VISCOSITY, pressure, slip / film);
        close(shear.friction, mean, 1e-10, "traction");
        // That integrated over the ellipse, as far as the documents promise it.
        if ratio >= 1e-3 && load >= 500.0 || ratio >= 1e-4 && load >= 1500.0 {
            close(shear.friction, local, 0.024, "traction under local pressure");
            near += 1;
        }
        // Its slope at no slip, over the rolling speed.
        let small = OIL.shear(VISCOSITY, pressure, 1e-16 / film);
        close(small.friction / 1e-16 * row[1], slope, 1e-9, "slope");
        assert!(small.thinning > 0.999_999);
        seen += 1;
    }
    assert_eq!(seen, 127);
    assert!(near > 40, "{near}");
}

/// Places and weights of Gauss and Legendre's quadrature over 0 to 1.
fn gauss(points: usize) -> Vec<[f64; 2]> {
    let legendre = |x: f64| {
        let (mut before, mut now) = (1.0, x);
        for k in 2..=points {
            let k = k as f64;
            (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
        }
        (now, points as f64 * (x * now - before) / (x * x - 1.0))
    };
    let place = |i: usize| {
        let guess = (std::f64::consts::PI * (i as f64 + 0.75) / (points as f64 + 0.5)).cos();
        (0..20).fold(guess, |x, _| x - legendre(x).0 / legendre(x).1)
    };
    (0..points)
        .map(|i| {
            let x = place(i);
            [0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * legendre(x).1.powi(2))]
        })
        .collect()
}

#[test]
fn order_of_convergence_of_shear_integrated_over_the_ellipse() {
    // Against the data's own integral over the ellipse, which has five digits.
    let hertz = Lubricant { shear_pressure: ShearPressure::Hertz, ..OIL };
    let worst = |shear: &dyn Fn(f64, f64) -> f64| {
        let apart = rows(TRACTION).map(|(_, row)| {
            let [_, _, _, slip, film, peak, _, local, ..] = row[..] else { panic!("{row:?}") };
            (shear(2.0 / 3.0 * peak, slip / film) / local - 1.0).abs()
        });
        apart.fold(0.0, f64::max)
    };
    let of = |points: usize| {
        let rings = gauss(points);
        worst(&|mean, rate| hertz.shear_over_ellipse(VISCOSITY, mean, rate, &rings).friction)
    };
    let errors = [3, 6, 12, 24].map(of);
    println!("3, 6, 12, 24 places: {errors:?}");
    // The edge of the limiting stress leaves the order two, what is smooth converges faster.
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0] / 4.0), "{errors:?}");
    assert!(errors[3] < 2e-5, "{errors:?}");
    // What simulations take has six of them.
    let taken = worst(&|mean, rate| hertz.shear(VISCOSITY, mean, rate).friction);
    assert!((taken / errors[1] - 1.0).abs() < 1e-9 && taken < 0.005, "{taken} {errors:?}");
    // From light to heavy contacts of thin and thick oils, from no shear to the limiting one.
    let (fine, mut most) = (gauss(64), 0.0f64);
    for mean in [0.3e9, 0.6e9, 1e9, 2e9, 2.7e9] {
        for viscosity in [0.003, 0.02, 0.1] {
            for rate in (-3..9).map(|power| 10f64.powi(power)) {
                let exact = hertz.shear_over_ellipse(viscosity, mean, rate, &fine).friction;
                most = most.max((hertz.shear(viscosity, mean, rate).friction / exact - 1.0).abs());
            }
        }
    }
    assert!(most < 0.0135, "{most}");
}

#[test]
fn independent_data_slope_of_light_contacts() {
    // As the documents have it: up to ten times steeper where a light contact hardly slips.
    let hertz = Lubricant { shear_pressure: ShearPressure::Hertz, ..OIL };
    let steepest = rows(TRACTION).fold(0.0f64, |most, (_, row)| {
        let [load, _, _, slip, film, peak, ..] = row[..] else { panic!("{row:?}") };
        let (mean, rate) = (2.0 / 3.0 * peak, slip / film);
        let ratio = hertz.shear(VISCOSITY, mean, rate).friction / OIL.shear(VISCOSITY, mean, rate).friction;
        if load <= 100.0 { most.max(ratio) } else { most }
    });
    assert!(steepest > 9.0 && steepest < 11.0, "{steepest}");
    // All oil at its limit carries the same share of any pressure.
    let limited = hertz.shear(VISCOSITY, 1e9, 1e12);
    close(limited.friction, OIL.limiting_shear, 2e-3, "limiting shear");
    assert!(limited.thinning < 1e-6, "{limited:?}");
    let viscous = hertz.shear(VISCOSITY, 1e8, 1.0);
    assert!(viscous.thinning > 0.999_999, "{viscous:?}");
}

/// Films of all laws.
fn of_all_laws(mut see: impl FnMut(&Film<'_>, &Loading<f64>)) {
    for mixed_friction in [MixedFriction::OlverSpikes, MixedFriction::Erf, MixedFriction::Skf] {
        for shear_pressure in [ShearPressure::Mean, ShearPressure::Hertz] {
            let lubricant = Lubricant { mixed_friction, shear_pressure, inlet_heating: true, ..OIL };
            for (load, speed, slip) in [
                (20.0, 5.0, 1e-3),
                (100.0, 0.1, 1e-4),
                (500.0, 5.0, 0.05),
                (1500.0, 0.02, 1e-3),
                (1500.0, 20.0, 1.0),
            ] {
                with_contact(true, load, speed, slip, |film, loading| {
                    let raceway = RacewayFilm::new(lubricant, MODULUS, film.raceway.ellipse);
                    let supply = Supply { dry_share: 0.3, ..film.supply };
                    see(&Film::new(&raceway, supply, film.dry_friction), loading);
                });
            }
        }
    }
}

#[test]
fn exact_derivatives_of_all_laws() {
    let numbers = |forces: FilmForces<f64>| [forces.friction, forces.viscous_share, forces.rolling_force];
    let mut seen = 0;
    of_all_laws(|film, loading| {
        let Loading { load, speed, slip, curvature, area } = *loading;
        let x = [load, speed, slip, curvature, area];
        let of = |x: [f64; 5]| {
            let [load, speed, slip, curvature, area] = x;
            numbers(film.forces(&Loading { load, speed, slip, curvature, area }))
        };
        let [load, speed, slip, curvature, area] = std::array::from_fn(|i| Dual::<5>::variable(x[i], i, 1.0));
        let exact = film.forces(&Loading { load, speed, slip, curvature, area });
        let exact = [exact.friction, exact.viscous_share, exact.rolling_force];
        for i in 0..5 {
            let change = 1e-5 * x[i];
            let [up, down] = [change, -change].map(|change| {
                let mut x = x;
                x[i] += change;
                of(x)
            });
            for (of, exact) in exact.iter().enumerate() {
                let difference = (up[of] - down[of]) / (2.0 * change);
                // Over what a change of all of a quantity would make.
                let error = (exact.derivatives[i] - difference).abs() * x[i] / exact.value.abs();
                assert!(error < 1e-7, "{:?} of {of} by {i}: {error}", film.raceway.lubricant);
                seen += 1;
            }
        }
    });
    assert_eq!(seen, 6 * 5 * 5 * 3);
}

#[test]
fn invariant_mixed_friction_of_all_laws_is_between_that_of_film_and_roughness() {
    of_all_laws(|film, loading| {
        let full = {
            let smooth =
                Lubricant { roughness: 1e-12, mixed_friction: MixedFriction::Erf, ..film.raceway.lubricant };
            let raceway = RacewayFilm::new(smooth, MODULUS, film.raceway.ellipse);
            Film::new(&raceway, film.supply, film.dry_friction).forces(loading).friction
        };
        let law = film.raceway.lubricant.mixed_friction;
        let mut shares = vec![];
        for lubrication in [1.0, 0.5, 0.2, 1e-9] {
            // As a whole bearing has it: 1500 rpm, 32 mm2/s, 46 mm.
            let dry_share = law.of_bearing(1500.0, 32.0, 0.046, lubrication);
            let supply = Supply { lubrication, dry_share, ..film.supply };
            let mixed = Film::new(film.raceway, supply, film.dry_friction).forces(loading).friction;
            shares.push((mixed - full) / (film.dry_friction - full));
        }
        // More of it is dry, the less oil there is; all at last.
        assert!(shares.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12), "{law:?}: {shares:?}");
        assert!(shares[0] >= -1e-12 && (shares[3] - 1.0).abs() < 1e-6, "{law:?}: {shares:?}");
    });
}

#[test]
fn published_dry_share_of_a_whole_bearing() {
    // By independent code, all of a 6206.
    for line in include_str!("../data/effects/skf_6206.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        close(MixedFriction::Skf.of_bearing(row[2], row[3], 0.046, 1.0), row[8], 1e-9, "phi_bl");
    }
}

#[test]
fn published_formula_of_rolling_resistance() {
    let mut seen = 0;
    for (inner, row) in rows(ROLLING) {
        let [load, speed, kappa, beta, m, force, moment, power, _] = row[..] else { panic!("{row:?}") };
        with_contact(inner, load, speed, 1e-3, |film, loading| {
            let Ellipse { ratio, slenderness, .. } = film.raceway.ellipse;
            close(ratio, kappa, 1e-9, "kappa");
            close(slenderness, beta, 1e-9, "beta");
            let ours = film.forces(loading).rolling_force;
            // Twelve digits of data, and the axis ratio of their own Hertz.
            close(ours, force, 1e-9, "rolling force");
            close(2.0 * ours / loading.curvature, moment, 1e-9, "moment");
            close(2.0 * ours * speed, power, 1e-9, "power");
            let u: f64 = 2.0 * VISCOSITY * speed * loading.curvature / MODULUS;
            let w = load * loading.curvature * loading.curvature / MODULUS;
            close(slenderness.powf(0.25) * ratio * w / u.powf(0.75), m, 1e-9, "M");
        });
        seen += 1;
    }
    assert_eq!(seen, 18);
}

#[test]
fn published_formula_of_rolling_resistance_beside_its_other_form() {
    // Balan and others (2015) write the same work by the ratio of curvatures, not by the ellipse.
    let mut apart: [f64; 2] = [f64::INFINITY, 0.0];
    for (inner, row) in rows(ROLLING) {
        let (load, speed) = (row[0], row[1]);
        with_contact(inner, load, speed, 1e-3, |film, loading| {
            let [along, across] = curvatures(inner);
            let kr: f64 = along / across;
            let u = VISCOSITY * speed * along / MODULUS;
            let w = load * along * along / MODULUS;
            let rigid = 2.9766 * kr.powf(0.3316) * w.cbrt() * u.powf(2.0 / 3.0);
            let elastic = 7.5826 * kr.powf(0.4055) * w.cbrt() * u.powf(0.75);
            let m = 0.5549 * kr.powf(-0.6029) * w * u.powf(-0.75);
            let theirs = (elastic + (rigid - elastic) / (1.0 + m / 6.6)) * MODULUS / (along * along);
            let ratio = film.forces(loading).rolling_force / theirs;
            apart = [apart[0].min(ratio), apart[1].max(ratio)];
        });
    }
    assert!(apart[0] > 0.99 && apart[1] < 1.01, "{apart:?}");
}

#[test]
fn invariant_films_hardly_depend_on_the_contact_angle_that_their_ellipse_is_of() {
    // Ellipses of the 6206 in the bottom of its grooves, and 40 degrees up their flanks.
    let mut worst = [0.0f64; 2];
    for inner in [true, false] {
        let [along, across] = curvatures(inner);
        let ball = 0.5 * 9.525e-3;
        // Radius of the pitch circle, below 0 for a race that lies around it.
        let pitch = 1.0 / (along - 1.0 / ball) + ball;
        let flank = 1.0 / ball + 1.0 / (pitch / 40f64.to_radians().cos() - ball);
        for (load, speed) in [(20.0, 1.0), (500.0, 5.0), (1500.0, 0.2), (1500.0, 20.0)] {
            let of = |curvature: f64| {
                let hertz = HertzContact::new(curvature, across, COMPLIANCE);
                let root = (load / hertz.stiffness).cbrt();
                let axes = [hertz.semi_axis_rolling * root, hertz.semi_axis_transverse * root];
                Ellipse::new(axes, load, MODULUS, curvature)
            };
            let [bottom, flank] = [along, flank].map(|curvature| {
                with_contact(inner, load, speed, 0.01 * speed, |film, loading| {
                    let raceway = RacewayFilm::new(OIL, MODULUS, of(curvature));
                    let forces = Film::new(&raceway, film.supply, 0.1).forces(loading);
                    [forces.rolling_force, forces.friction]
                })
            });
            for i in 0..2 {
                worst[i] = worst[i].max((flank[i] / bottom[i] - 1.0).abs());
            }
        }
    }
    println!("rolling force, friction: {worst:?}");
    // What docs/oil.md states, to its last digit.
    assert!(worst[0] < 0.0225 && worst[1] < 0.003, "{worst:?}");
}

#[test]
fn limits_of_a_film() {
    // Mixed friction between dry and full; a film that grows without bound where there is no load; heat that never eats all of it.
    let friction = |slip: f64, lubrication: f64| {
        with_contact(true, 500.0, 5.0, slip, |film, loading| {
            let supply = Supply { lubrication, ..film.supply };
            Film::new(film.raceway, supply, film.dry_friction).forces(loading).friction
        })
    };
    let full = friction(0.05, 1.0);
    assert!(full > 0.03 && full < 0.06, "{full}");
    assert!((friction(0.05, 1e-9) - 0.1).abs() < 1e-6);
    let growing: Vec<f64> = [1.0, 0.5, 0.2, 0.1, 0.01].map(|degree| friction(0.05, degree)).into();
    assert!(growing.windows(2).all(|pair| pair[0] < pair[1]), "{growing:?}");
    for (load, speed) in [(0.0f64, 5.0), (1e-6, 1e-3), (1e5, 1e-3), (500.0, 1e3), (1e5, 1e3)] {
        with_contact(true, load.max(1e-12), speed, 1.0, |film, loading| {
            let heating = Lubricant { inlet_heating: true, ..OIL };
            let heated = RacewayFilm::new(heating, MODULUS, film.raceway.ellipse);
            let film = Film::new(&heated, film.supply, film.dry_friction);
            let loading = Loading { load, area: if load == 0.0 { 0.0 } else { loading.area }, ..*loading };
            let forces = film.forces(&loading);
            for number in [forces.friction, forces.viscous_share, forces.rolling_force] {
                assert!(number.is_finite() && number >= 0.0, "{load} N, {speed} m/s: {forces:?}");
            }
            assert!(forces.friction <= 0.1 && forces.viscous_share <= 1.0, "{forces:?}");
        });
    }
    // Thick rigid inlets without load.
    let inlet = Inlet { load: 0.0, speed: 1e-9f64.ln(), half_width: 0.0 };
    let ellipse = with_contact(true, 500.0, 5.0, 1.0, |film, _| film.raceway.ellipse);
    assert_eq!(inlet.rolling_force(&ellipse.rolling), 0.0);
    assert_eq!(rolling::inlet_factor(f64::NEG_INFINITY), 1.0);
}

#[test]
fn published_viscosities_by_grade_and_temperature() {
    let kinematic = |grade: f64, temperature: f64| Oil::Graded(grade, 1000.0).viscosity(temperature) * 1e3;
    for grade in [10.0, 32.0, 68.0, 100.0, 220.0, 460.0] {
        close(kinematic(grade, 40.0), grade, 1e-12, "at 40 degC");
    }
    // Viscosities at 100 degC of mineral oils with an index of 95 to 97, as data sheets have them, within 3 %.
    for (grade, hot) in
        [(32.0, 5.4), (46.0, 6.8), (68.0, 8.7), (100.0, 11.1), (150.0, 14.7), (220.0, 19.0), (320.0, 24.1)]
    {
        close(kinematic(grade, 100.0), hot, 0.03, "at 100 degC");
    }
    // Between grades as between their logarithms.
    assert!(
        kinematic(57.0, 100.0) > kinematic(46.0, 100.0) && kinematic(57.0, 100.0) < kinematic(68.0, 100.0)
    );
    // The fall with temperature is the slope.
    let oil = Oil::Graded(68.0, 880.0);
    let slope = -(oil.viscosity(70.001).ln() - oil.viscosity(69.999).ln()) / 0.002;
    close(oil.falls(70.0).unwrap(), slope, 1e-6, "fall");
}
