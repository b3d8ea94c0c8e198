//! Housings that bearings of a shaft share.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3};
use roulement::simulation::system::{PointOutput, System};

use crate::common::{GEARBOX, assert_order_two, forces, imbalance, scene, stored, system};

/// The gearbox shaft with both bearings in one housing.
fn in_housing(housing: &str) -> String {
    let sitting = GEARBOX.replace("mounting = {", "mounting = { housing = \"case\",");
    sitting.replacen("[[bearing]]", &format!("{housing}\n[[bearing]]"), 1)
}

/// A rigid housing of 12 kg with its centre below the axis, held by these springs there.
fn rigid(stiffness: &str) -> String {
    in_housing(&format!(
        "[[housing]]\nname = \"case\"\nmass = \"12 kg\"\ninertia = [0.06, 0.08, 0.09]\ncentre = [0.01, 0, \"-20 mm\"]\n\
         stiffness = {stiffness}\n[[housing.point]]\nname = \"top\"\nposition = [0.02, 0.03, 0.06]\n"
    ))
}

const FEET: &str = "[[housing]]
name = \"case\"
mass = \"12 kg\"
inertia = [0.06, 0.08, 0.08]
centre = [0, 0, \"-20 mm\"]
[[housing.load]]
name = \"shock\"
position = [0, 0, \"60 mm\"]
force = [0, 0, SHOCK]
";

/// Four feet at (+-80, +-90, -100) mm, with a stiffness in N/um along x and y, twice that along z.
fn on_feet(stiffness: f64, damping: f64, shock: &str) -> String {
    let feet = [(-1, -1), (-1, 1), (1, -1), (1, 1)].map(|(x, y)| {
        format!(
            "[[housing.foot]]\nposition = [{}, {}, -0.1]\nstiffness = [{k}, {k}, {}]\ndamping = [{damping}, {damping}, {damping}]\n",
            0.08 * f64::from(x),
            0.09 * f64::from(y),
            2.0 * stiffness * 1e6,
            k = stiffness * 1e6
        )
    });
    in_housing(&(FEET.replace("SHOCK", shock) + &feet.concat()))
}

/// Displacement and rotation of a rigid body at its centre, from those of one of its points.
fn apart(point: &PointOutput, arm: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    (point.displacement - point.tilt.cross(&arm), point.tilt)
}

#[test]
fn invariant_a_housing_that_cannot_move_is_none() {
    let stiff = rigid("[1e14, 1e14, 1e14, 1e12, 1e12, 1e12]");
    let (mut with, mut without) = (system(&stiff), system(GEARBOX));
    for system in [&mut with, &mut without] {
        system.advance(5e-4).unwrap();
    }
    for (a, b) in forces(&with).iter().zip(forces(&without)) {
        assert!((a - b).norm() < 1e-5 * b.norm(), "{a} {b}");
    }
}

/// What the bearings and the weight do to the housing, over its springs by hand, is how far it goes.
#[test]
fn closed_form_a_housing_yields_as_its_springs_say() {
    let diagonal = [2e7, 1e8, 5e7, 4e5, 6e5, 8e5];
    // Without friction and gyroscopic moments wrenches are those of the equilibrium: balls that start at one common speed creep otherwise.
    let smooth = "[bearing.set]\nfriction.ball_race = 0.0\n";
    let text = rigid("[2e7, 1e8, 5e7, 4e5, 6e5, 8e5]")
        .replace("6000 rpm", "10 rpm")
        .replace("[load]", &format!("{smooth}[load]"))
        .replace("[[bearing]]\nname = \"right\"", &format!("{smooth}[[bearing]]\nname = \"right\""));
    let system = system(&text);
    let centre = Vector3::new(0.01, 0.0, -0.02);
    let mut force = Vector3::new(0.0, 0.0, -9.81 * 12.0);
    let mut moment = Vector3::zeros();
    for ((_, bearing), mounted) in system.bearings().zip(&system.scene().bearings) {
        let sign = mounted.mounting.direction.sign();
        let turned = |v: Vector3<f64>| Vector3::new(sign * v.x, sign * v.y, v.z);
        let wrench = bearing.outputs().outer.wrench;
        let on_it = turned(wrench.force);
        // Contacts without friction carry what the balls weigh in their planes: half of it. In statics friction has the other half.
        let balls = bearing.state().balls.len() as f64 * bearing.model().bearing.ball.mass;
        let on_it = on_it + Vector3::new(0.0, 0.0, -0.5 * 9.81 * balls);
        force += on_it;
        let place = Vector3::new(mounted.mounting.position.0, 0.0, 0.0);
        moment += turned(wrench.moment) + (place - centre).cross(&on_it);
    }
    let by_hand = |k: usize| if k < 3 { force[k] / diagonal[k] } else { moment[k - 3] / diagonal[k] };
    let housing = &system.outputs().housings[0];
    for (point, arm) in [
        (housing.seats[0], Vector3::new(-0.06, 0.0, 0.02)),
        (housing.points[0], Vector3::new(0.01, 0.03, 0.08)),
    ] {
        let (moved, turned) = apart(&point, arm);
        // Forces of 1.5 kN along axes that are tilted by 0.1 mrad.
        for k in 0..3 {
            let force = (moved[k] - by_hand(k)) * diagonal[k];
            let moment = (turned[k] - by_hand(k + 3)) * diagonal[k + 3];
            assert!(force.abs() < 0.4 && moment.abs() < 0.4 * 0.06, "{k}: {force} N, {moment} N m");
        }
    }
    // The mesh pushes by 1260 N up, the springs give way by more than rounding.
    assert!(housing.seats[0].displacement.z > 1e-5, "{:?}", housing.seats[0]);
}

/// Feet are springs at places: the same as the 6 x 6 matrix of their sum, written by hand.
#[test]
fn closed_form_feet_are_the_matrix_of_their_sum() {
    let (k, kz) = (4.0 * 50e6, 4.0 * 100e6);
    // Feet lie 80 mm below the centre of mass.
    let (x, y, z) = (0.08f64, 0.09f64, -0.08f64);
    let mut matrix = Matrix6::from_diagonal(&nalgebra::Vector6::new(
        k,
        k,
        kz,
        k * z * z + kz * y * y,
        k * z * z + kz * x * x,
        k * (x * x + y * y),
    ));
    // A turn about y moves the feet by z along x, one about x by -z along y.
    (matrix[(0, 4)], matrix[(4, 0)]) = (k * z, k * z);
    (matrix[(1, 3)], matrix[(3, 1)]) = (-k * z, -k * z);
    let rows: Vec<String> =
        (0..6).map(|i| format!("{:?}", (0..6).map(|j| matrix[(i, j)]).collect::<Vec<_>>())).collect();
    let housing = FEET
        .replace("SHOCK", "0")
        .replace("[[housing.load]]", &format!("stiffness = [{}]\n[[housing.load]]", rows.join(", ")));
    let (mut feet, mut matrix) = (system(&on_feet(50.0, 0.0, "0")), system(&in_housing(&housing)));
    for system in [&mut feet, &mut matrix] {
        system.advance(2e-4).unwrap();
    }
    let at = |system: &System| system.outputs().housings[0].seats[1];
    let (a, b) = (at(&feet), at(&matrix));
    assert!(
        (a.displacement - b.displacement).norm() < 1e-12 && (a.tilt - b.tilt).norm() < 1e-11,
        "{a:?} {b:?}"
    );
    assert!(a.displacement.norm() > 1e-6);
}

#[test]
fn invariant_matrices_of_a_rigid_housing_are_the_rigid_housing() {
    let diagonal = [2e7, 1e8, 5e7, 4e5, 6e5, 8e5];
    let square = |values: &[f64]| {
        let rows = DMatrix::from_diagonal(&DVector::from_row_slice(values));
        let rows: Vec<Vec<f64>> = (0..6).map(|i| rows.row(i).iter().copied().collect()).collect();
        format!("{rows:?}")
    };
    let centre = Vector3::new(0.01, 0.0, -0.02);
    let station = |place: Vector3<f64>, written: &str| {
        let mut map = Matrix6::identity();
        map.fixed_view_mut::<3, 3>(0, 3).copy_from(&-(place - centre).cross_matrix());
        let rows: Vec<Vec<f64>> = (0..6).map(|i| map.row(i).iter().copied().collect()).collect();
        format!("{{ position = {written}, map = {rows:?} }}")
    };
    let stations = [
        station(Vector3::new(-0.05, 0.0, 0.0), "-0.05"),
        station(Vector3::new(0.05, 0.0, 0.0), "[0.05, 0.0, 0.0]"),
        station(Vector3::new(0.02, 0.03, 0.06), "[0.02, 0.03, 0.06]"),
    ];
    let unit = "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]";
    let matrices = format!(
        "[[housing]]\nname = \"case\"\nmatrices = {{ mass = {}, stiffness = {}, translations = {unit}, stations = [{}] }}\n\
         [[housing.point]]\nname = \"top\"\nposition = [0.02, 0.03, 0.06]\n",
        square(&[12.0, 12.0, 12.0, 0.06, 0.08, 0.09]),
        square(&diagonal),
        stations.join(", ")
    );
    let (mut a, mut b) = (system(&in_housing(&matrices)), system(&rigid(&format!("{diagonal:?}"))));
    for system in [&mut a, &mut b] {
        system.advance(2e-4).unwrap();
    }
    let at = |system: &System| system.outputs().housings[0].points[0];
    assert!((at(&a).displacement - at(&b).displacement).norm() < 1e-13);
    assert!((at(&a).tilt - at(&b).tilt).norm() < 1e-12);
}

/// A soft housing swings on its springs with shaft and bearings as one mass: the period of that.
#[test]
fn closed_form_a_housing_on_soft_springs_swings_with_all_that_is_in_it() {
    let stiffness = "[1e9, 1e9, 2e5, 1e7, 1e7, 1e7]";
    let text = rigid(stiffness)
        .replace("force = [337.8, -475.0, 1260.5]", "force = [0, 0, [[0, 200], [\"10 us\", 0]]]")
        .replace("moment = [30.0, 0, -8.04]", "moment = [0, 0, 0]")
        .replace("gravity = [0, 0, -9.81]", "gravity = [0, 0, 0]")
        .replace("centre = [0.01, 0, \"-20 mm\"]", "centre = [0, 0, 0]")
        .replace("6000 rpm", "600 rpm");
    let mut system = system(&text);
    let mass = 12.0 + 1.8 + system.bearings().map(|(_, b)| balls(b)).sum::<f64>();
    let expected = std::f64::consts::PI * (mass / 2e5).sqrt();
    // Half a period after the release it is at the other side: the speed passes zero.
    let mut before = (0.0, 0.0);
    let found = (1..=1000).find_map(|row| {
        let time = f64::from(row) * 5e-5;
        system.advance(time).unwrap();
        let speed = system.outputs().housings[0].seats[0].velocity.z;
        let crossed = (before.1 < 0.0 && speed >= 0.0).then(|| {
            let (earlier, slow): (f64, f64) = before;
            earlier + (time - earlier) * slow / (slow - speed)
        });
        before = (time, speed);
        crossed
    });
    let found = found.unwrap();
    assert!((found / expected - 1.0).abs() < 5e-3, "{found} {expected}");
}

/// \[kg] balls of a bearing.
fn balls(bearing: &roulement::Simulation) -> f64 {
    let ball = &bearing.model().bearing.ball;
    ball.mass * bearing.state().balls.len() as f64
}

#[test]
fn order_of_convergence_of_a_shaft_in_a_soft_housing_is_two() {
    let text = on_feet(20.0, 500.0, "[[0, 0], [\"200 us\", -2000], [\"400 us\", 0]]");
    assert_order_two(&text, 4e-4, 1e-6, |system| system.outputs().housings[0].seats[0].displacement);
}

#[test]
fn hard_case_a_shock_on_the_housing() {
    // 12 kN for half a millisecond: a hundred times the weight of the housing.
    let text = on_feet(60.0, 2e3, "[[0, 0], [\"0.5 ms\", 0], [\"0.75 ms\", -12000], [\"1 ms\", 0]]");
    let mut system = system(&text);
    let before = stored(&system);
    let mut largest = 0.0f64;
    for row in 1..=60 {
        system.advance(f64::from(row) * 1e-4).unwrap_or_else(|why| panic!("{why}"));
        largest = largest.max(system.outputs().housings[0].seats[0].displacement.z.abs());
    }
    assert!(largest > 2e-5, "{largest}");
    let [shaft, bearings] = imbalance(&system, &before);
    let housing = &system.outputs().housings[0].energies;
    let turned_over = housing.input.abs() + housing.bearings.abs() + housing.damping;
    let housing = housing.unaccounted().abs() / turned_over;
    assert!(shaft < 1e-4 && bearings < 1e-2 && housing < 1e-4, "{shaft:.2e} {bearings:.2e} {housing:.2e}");
}

#[test]
fn regression_a_saved_state_with_a_housing_goes_on_to_the_same_bits() {
    let mut system = system(&on_feet(60.0, 2e3, "[[0, 0], [\"200 us\", -3000], [\"300 us\", 0]]"));
    system.advance(1.5e-4).unwrap();
    let saved = system.snapshot();
    let mut other = System::new(system.scene()).unwrap();
    assert!(other.restore(&saved));
    for one in [&mut system, &mut other] {
        one.advance(3e-4).unwrap();
    }
    assert_eq!(system.outputs(), other.outputs());
    assert_eq!(system.snapshot(), other.snapshot());
    // A snapshot of a shaft without the housing is refused.
    assert!(!other.restore(&crate::common::system(GEARBOX).snapshot()));
}

#[test]
fn the_text_that_stands_alone_is_the_same_system() {
    let one = scene(&on_feet(60.0, 2e3, "0"));
    let again =
        roulement::scene::system::SystemScene::parse(&one.source, None, std::path::Path::new("")).unwrap();
    let [a, b] = [one, again].map(|scene| System::new(&scene).unwrap());
    assert_eq!(a.outputs(), b.outputs());
}

#[test]
fn refusals_of_housings_name_key_value_and_allowed_range() {
    let good = on_feet(60.0, 2e3, "0");
    let last_bearing = "[bearing.set.outer]\n";
    for (from, to, parts) in [
        ("mass = \"12 kg\"", "mass = \"0 kg\"", &["housing \"case\"", "housing.mass = 0 kg", "(0,"][..]),
        ("mass = \"12 kg\"\n", "", &["housing.mass", "mass and inertia"]),
        ("housing = \"case\"", "housing = \"box\"", &["housing = \"box\"", "there are: case"]),
        ("name = \"case\"", "name = \"left\"", &["left", "names of their own"]),
        ("name = \"shock\"", "name = \"mesh\"", &["mesh", "names of their own"]),
        ("position = [0.08, 0.09, -0.1]", "position = [0.08, 0.09]", &["position"]),
        ("60000000, 120000000]", "60000000, -1]", &["housing.foot.stiffness = -1"]),
        (
            "centre = [0, 0, \"-20 mm\"]",
            "stiffness = [[1,1,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]",
            &["not symmetric"],
        ),
        (
            "[load]",
            &format!("{last_bearing}drive = \"hinge\"\n[load]"),
            &["\"right\"", "outer.drive", "mounting.housing"],
        ),
        (
            "[load]",
            "[bearing.set.outer.misalignment]\nrz = 0.001\n[load]",
            &["outer.misalignment", "mounting.housing"],
        ),
        (
            "[load]",
            &format!(
                "{last_bearing}support = {{ stiffness = [1e8, 1e8, 1e8, 1e5, 1e5, 1e5], mass = 0.1, inertia = [1e-4, 1e-4, 1e-4] }}\n[load]"
            ),
            &["outer.support", "mounting.housing"],
        ),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let refusal = roulement::scene::system::SystemScene::parse(&text, None, std::path::Path::new(""))
            .unwrap_err()
            .to_string();
        for part in parts {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
    // One foot holds no turn.
    let one =
        FEET.replace("SHOCK", "0") + "[[housing.foot]]\nposition = [0, 0, 0]\nstiffness = [1e8, 1e8, 1e8]\n";
    let refusal = System::new(&scene(&in_housing(&one))).unwrap_err().to_string();
    assert!(refusal.contains("housing \"case\"") && refusal.contains("three feet"), "{refusal}");
    let empty = GEARBOX.replacen("[[bearing]]", &format!("{}\n[[bearing]]", FEET.replace("SHOCK", "0")), 1);
    let refusal = roulement::scene::system::SystemScene::parse(&empty, None, std::path::Path::new(""))
        .unwrap_err()
        .to_string();
    assert!(refusal.contains("case"), "{refusal}");
}
