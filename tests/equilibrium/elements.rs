//! Balls in balance at every place of the rings, without states, against the equilibrium of the whole bearing: loads, stiffness, exact derivatives,
//! and a potential.

use std::f64::consts::PI;

use nalgebra::{Matrix6, SMatrix, UnitQuaternion, Vector2, Vector3, Vector6};
use roulement::Model;
use roulement::contact::normal::Damping;
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::Conditions;
use roulement::quasi_static::ball::{Ball, Couple, Groove};
use roulement::quasi_static::bearing::{Balls, Rested, RingMotion};
use roulement::quasi_static::rings::Placed;
use roulement::scene::Scene;

use crate::random::Random;

/// A deep groove bearing like 6206, and an angular contact one like 7206 B.
const DEEP_GROOVE: &str =
    "balls = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\ndiametral_clearance = ";
const ANGULAR: &str =
    "balls = 13\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\ncontact_angle = ";

/// A case: what bearing, its speed and its loads.
struct Case {
    bearing: &'static str,
    given: &'static str,
    rpm: f64,
    load: &'static str,
}

const CASES: [Case; 14] = [
    Case { bearing: DEEP_GROOVE, given: "10 um", rpm: 0.0, load: "y = { force = \"2 kN\" }" },
    Case { bearing: DEEP_GROOVE, given: "10 um", rpm: 6000.0, load: "y = { force = \"2 kN\" }" },
    Case { bearing: DEEP_GROOVE, given: "40 um", rpm: 3000.0, load: "y = { force = \"500 N\" }" },
    Case { bearing: DEEP_GROOVE, given: "-10 um", rpm: 3000.0, load: "z = { force = \"-1 kN\" }" },
    Case {
        bearing: DEEP_GROOVE,
        given: "12 um",
        rpm: 20000.0,
        load: "x = { force = \"300 N\" }\ny = { force = \"300 N\" }",
    },
    Case {
        bearing: DEEP_GROOVE,
        given: "12 um",
        rpm: 1500.0,
        load: "x = { force = \"1 kN\" }\ny = { force = \"1 kN\" }",
    },
    Case {
        bearing: DEEP_GROOVE,
        given: "12 um",
        rpm: 6000.0,
        load: "x = { force = \"500 N\" }\ny = { force = \"1 kN\" }\nry = { rotation = 0.002 }\nrz = { rotation = -0.001 }",
    },
    Case {
        bearing: DEEP_GROOVE,
        given: "12 um",
        rpm: 6000.0,
        load: "x = { displacement = 0 }\ny = { displacement = 0 }\nz = { displacement = 0 }\nrz = { rotation = 0.006 }",
    },
    Case { bearing: ANGULAR, given: "40 deg", rpm: 0.0, load: "x = { force = \"1 kN\" }" },
    Case {
        bearing: ANGULAR,
        given: "40 deg",
        rpm: 12000.0,
        load: "x = { force = \"1 kN\" }\ny = { force = \"800 N\" }",
    },
    Case { bearing: ANGULAR, given: "25 deg", rpm: 30000.0, load: "x = { force = \"400 N\" }" },
    Case {
        bearing: ANGULAR,
        given: "15 deg",
        rpm: 24000.0,
        load: "x = { force = \"300 N\" }\nz = { force = \"400 N\" }",
    },
    Case {
        bearing: ANGULAR,
        given: "25 deg",
        rpm: 6000.0,
        load: "x = { displacement = \"10 um\" }\ny = { force = \"1 kN\" }",
    },
    Case {
        bearing: ANGULAR,
        given: "40 deg",
        rpm: 3000.0,
        load: "x = { force = \"2 kN\" }\nry = { moment = \"5 N m\" }",
    },
];

/// What a case is solved to, and its balls there.
struct Solved {
    input: EquilibriumInput,
    model: Model,
    conditions: Conditions,
    solution: Equilibrium,
    balls: Balls,
    motion: RingMotion,
    rested: Vec<Rested>,
}

fn axis(ry: f64, rz: f64) -> Vector3<f64> {
    UnitQuaternion::new(Vector3::new(0.0, ry, rz)) * Vector3::x()
}

impl Case {
    fn solved(&self) -> Solved {
        let Self { bearing, given, rpm, load } = self;
        let text = format!(
            "[bearing]\n{bearing}\"{given}\"\ninner_conformity = 0.52\nouter_conformity = 0.53\n\n[inner]\ndrive = \"wrench\"\nmass = \"0.2 kg\"\n\
             inertia = [1e-4, 1e-4, 1e-4]\nshoulder_height = [\"4 mm\", \"4 mm\"]\n\n[outer]\nshoulder_height = [\"4 mm\", \"4 mm\"]\n\n[load]\nduration = 0.01\n\
             inner_speed = \"{rpm} rpm\"\n{load}\n"
        );
        let scene = Scene::parse(&text).unwrap_or_else(|why| panic!("{text}\n{why}"));
        let model = Model::new(&scene).unwrap();
        let input = EquilibriumInput::from_scene(&scene, Gyroscopic::Friction);
        let solution = equilibrium::solve(&model, &input).unwrap_or_else(|why| panic!("{text}\n{why}"));
        let conditions = input.with_friction();
        let balls = Balls::new(&model, &conditions, [solution.cage_speed, 0.0]);
        let [x, y, z, ry, rz] = solution.displacement;
        let placed = Placed { position: Vector3::new(x, y, z), axis: axis(ry, rz) };
        let motion = RingMotion { placed, twist: Vector6::zeros(), turn: [0.0, 0.0] };
        let rested = balls.placed(&model, &conditions, &motion);
        Solved { input, model, conditions, solution, balls, motion, rested }
    }
}

#[test]
fn independent_data_loads_and_stiffness_are_those_of_the_equilibrium_of_the_whole_bearing() {
    for case in &CASES {
        let name = format!("{} {} rpm {}", case.given, case.rpm, case.load);
        let Solved { input, model, conditions, solution, balls, motion, rested } = case.solved();
        let loads = solution.balls.iter().map(|ball| [ball.report.inner_load, ball.report.outer_load]);
        let largest = loads.clone().flatten().fold(0.0, f64::max);
        for (index, (own, of)) in rested.iter().zip(loads).enumerate() {
            for race in 0..2 {
                let error = (own.loads[race] - of[race]).abs();
                assert!(error < 2e-3 * largest, "{name}: ball {index}: {} {}", own.loads[race], of[race]);
            }
        }
        let forces = balls.forces(&motion, &rested, |_, _, _| ());
        let size: f64 = rested.iter().map(|ball| ball.loads[0]).sum();
        for (k, row) in [0, 1, 2, 4, 5].into_iter().enumerate() {
            let arm = if k < 3 { 1.0 } else { 0.023 };
            let error = (forces.wrench[row] + solution.load[k]).abs();
            assert!(error < 1e-3 * size * arm, "{name}: {row}: {} {}", forces.wrench[row], solution.load[k]);
        }
        // The stiffness of the equilibrium is that of a cage which takes the speed of each place, for which vibrations leave no time: the derivative at
        // a given speed, and what the speed does beside it.
        let tangents = balls.tangents(&motion, &rested);
        let scale = |k: usize| if k < 3 { 1.0 } else { 0.023 };
        let rows = [0, 1, 2, 4, 5];
        let mut own = SMatrix::<f64, 5, 5>::zeros();
        for (k, column) in rows.into_iter().enumerate() {
            let step = 2e-8 / scale(k);
            let speed = |sign: f64| {
                let mut displacement = solution.displacement;
                displacement[k] += sign * step;
                let input =
                    EquilibriumInput { conditions: displacement.map(Prescribed::Motion), ..input.clone() };
                equilibrium::solve(&model, &input).unwrap().cage_speed
            };
            let by_place = (speed(1.0) - speed(-1.0)) / (2.0 * step);
            let at = |speed: f64| {
                Balls::new(&model, &conditions, [speed, 0.0]).forces(&motion, &rested, |_, _, _| ()).wrench
            };
            let change = 1e-4 * solution.cage_speed.max(1.0);
            let by_speed =
                (at(solution.cage_speed + change) - at(solution.cage_speed - change)) / (2.0 * change);
            for (i, row) in rows.into_iter().enumerate() {
                own[(i, k)] = -(tangents.by_displacement[(row, column)] + by_speed[row] * by_place);
            }
        }
        let sized = |matrix: &SMatrix<f64, 5, 5>| {
            SMatrix::<f64, 5, 5>::from_fn(|i, k| matrix[(i, k)] / (scale(i) * scale(k)))
        };
        let (own, of) = (sized(&own), sized(&solution.stiffness));
        assert!((own - of).amax() < 0.02 * of.amax(), "{name}: {own:.5e} {of:.5e}");
    }
}

/// The ring moved by a displacement and a rotation.
fn moved(ring: &RingMotion, by: &Vector6<f64>) -> RingMotion {
    let turn = UnitQuaternion::new(by.fixed_rows::<3>(3).into_owned());
    let Placed { position, axis } = ring.placed;
    let placed = Placed { position: position + by.fixed_rows::<3>(0), axis: turn * axis };
    RingMotion { placed, ..*ring }
}

#[test]
fn closed_form_derivatives_are_those_of_differences() {
    for case in &CASES {
        let Solved { balls, motion, rested, .. } = case.solved();
        let tangents = balls.tangents(&motion, &rested);
        let wrench = |motion: &RingMotion| balls.forces(motion, &rested, |_, _, _| ()).wrench;
        let scale = Vector6::new(1.0, 1.0, 1.0, 0.023, 0.023, 0.023);
        let mut numeric = Matrix6::zeros();
        for k in 0..6 {
            let step = 2e-9 / scale[k];
            let at = |sign: f64| wrench(&moved(&motion, &(Vector6::ith(k, sign * step))));
            numeric.set_column(k, &((at(1.0) - at(-1.0)) / (2.0 * step)));
        }
        let sized = |matrix: &Matrix6<f64>| Matrix6::from_fn(|i, k| matrix[(i, k)] / (scale[i] * scale[k]));
        let (exact, numeric) = (sized(&tangents.by_displacement), sized(&numeric));
        let error = (exact - numeric).amax();
        assert!(
            error < 1e-4 * exact.amax(),
            "{} {}: {error:.3e}\n{exact:.4e}{numeric:.4e}",
            case.given,
            case.rpm
        );

        let turned = |angle: f64| wrench(&RingMotion { turn: [angle, 0.0], ..motion });
        let by_turn = (turned(1e-6) - turned(-1e-6)) / 2e-6;
        let error = (tangents.by_turn - by_turn).component_div(&scale).amax();
        let size = rested.iter().map(|ball| ball.loads[0]).sum::<f64>();
        assert!(error < 1e-5 * size, "{} {}: {error:.3e} of {size}", case.given, case.rpm);
    }
}

#[test]
fn closed_form_damping_takes_what_it_loses_and_is_the_derivative_by_velocities() {
    let case = Case { bearing: DEEP_GROOVE, given: "-10 um", rpm: 3000.0, load: "y = { force = \"1 kN\" }" };
    let Solved { mut model, conditions, motion, rested, solution, .. } = case.solved();
    for damping in [Damping::HuntCrossley(0.5), Damping::Viscoelastic(1e-6)] {
        model.damping = damping;
        let balls = Balls::new(&model, &conditions, [solution.cage_speed, 0.0]);
        let still = balls.forces(&motion, &rested, |_, _, _| ()).wrench;
        let twist = Vector6::new(1e-3, -2e-3, 3e-3, 0.0, 0.05, -0.02);
        let moving = balls.forces(&RingMotion { twist, ..motion }, &rested, |_, _, _| ());
        let of_damping = moving.wrench - still;
        let linear = balls.tangents(&motion, &rested).by_rate * twist;
        assert!((of_damping - linear).amax() < 1e-9 * of_damping.amax(), "{of_damping} {linear}");
        let lost = -of_damping.dot(&twist);
        assert!(lost > 0.0 && (moving.damped / lost - 1.0).abs() < 1e-9, "{} {lost}", moving.damped);
    }
}

#[test]
fn invariant_what_rings_do_along_any_way_is_stored() {
    // A potential at a given speed, without the gyroscopic couple: friction carries none.
    for (given, rpm) in [("10 um", 0.0), ("10 um", 12000.0), ("-5 um", 6000.0)] {
        let case = Case {
            bearing: DEEP_GROOVE,
            given,
            rpm,
            load: "x = { force = \"500 N\" }\ny = { force = \"1 kN\" }",
        };
        let Solved { model, conditions, motion, mut rested, solution, .. } = case.solved();
        let frictionless = Conditions { friction: 0.0, ..conditions };
        let balls = Balls::new(&model, &frictionless, [solution.cage_speed, 0.0]);
        let stiffness: Vec<[f64; 2]> = rested.iter().map(|ball| ball.stiffness).collect();
        let at = |s: f64| {
            let way = Vector6::new(
                8e-6 * s.sin(),
                5e-6 * (2.0 * s).sin(),
                6e-6 * (1.0 - s.cos()),
                0.0,
                5e-4 * s.sin(),
                4e-4 * (s.cos() - 1.0),
            );
            RingMotion { turn: [0.3 * s, 0.0], ..moved(&motion, &way) }
        };
        let (steps, end) = (4000, 2.0);
        let (mut done, mut kept, mut most) = (0.0, 0.0, 0.0f64);
        let first = balls.rest(&model, &frictionless, &at(0.0), &mut rested);
        let mut before: Option<(RingMotion, Vector6<f64>, f64, Vec<Rested>)> = None;
        for k in 0..=steps {
            let motion = at(end * f64::from(k) / f64::from(steps));
            // Stiffnesses stay those of the start: what they put in is not looked at here.
            rested.iter_mut().zip(&stiffness).for_each(|(ball, stiffness)| ball.stiffness = *stiffness);
            let forces = balls.rest(&model, &frictionless, &motion, &mut rested);
            if let Some((from, wrench, turning, old)) = &before {
                let moved = motion.placed.position - from.placed.position;
                // Of so small an angle, which quaternions would round.
                let turned = from.placed.axis.cross(&motion.placed.axis);
                let way = Vector6::new(moved.x, moved.y, moved.z, turned.x, turned.y, turned.z);
                let mean = 0.5 * (turning + forces.turning);
                done -= 0.5 * (wrench + forces.wrench).dot(&way) + mean * (motion.turn[0] - from.turn[0]);
                kept += balls.put_in(old, &rested);
            }
            most = most.max((forces.elastic - first.elastic).abs());
            before = Some((motion, forces.wrench, forces.turning, rested.clone()));
        }
        let stored: f64 = rested.iter().map(|ball| ball.elastic).sum::<f64>() - first.elastic;
        let open = done + kept - stored;
        assert!(
            open.abs() < 2e-6 * most,
            "{given} {rpm}: {open:.3e} of {most:.3e} ({done:.3e} {kept:.3e} {stored:.3e})"
        );
    }
}

#[test]
fn invariant_a_ball_is_found_from_anywhere_and_in_one_place() {
    let groove = |arc: f64, stiffness: f64| Groove { arc, stiffness };
    let mut source = Random::new(12345);
    let mut random = || source.unit();
    for _ in 0..20_000 {
        let arcs = [0.19e-3, 0.28e-3];
        let centrifugal = [0.0, 1e-6, 1e-2, 5.0, 200.0][(5.0 * random()) as usize];
        // `J w_m w_roll/r = 0.4 m w_m^2 R` of a solid ball on an outer ring that rests, more on one that turns against the inner one.
        let couple =
            (random() < 0.5).then(|| Couple { force: 0.8 * centrifugal * (random() - 0.5), friction: 0.1 });
        let ball = Ball {
            grooves: [groove(arcs[0], 8e9), groove(arcs[1], 1e10)],
            centrifugal,
            couple: couple.filter(|couple| couple.force != 0.0),
            damping: Damping::HuntCrossley(0.0),
        };
        // From a gap to 40 um of overlap, at any contact angle, and exactly at the onset.
        let gap = if random() < 0.1 { 0.0 } else { -1e-5 + 5e-5 * random().powi(2) };
        let angle = (random() - 0.5) * 0.9 * PI;
        let c = Vector2::new(angle.sin(), angle.cos()) * (arcs[0] + arcs[1] + gap);
        let near = ball.settle(&c, &(c * 0.6), &[Vector2::zeros(); 2]);
        let far = Vector2::new(2e-4 * (random() - 0.5), 1e-3 * random());
        let other = ball.settle(&c, &far, &[Vector2::new(0.1, -0.2) * centrifugal; 2]);
        let size = near.loads[0] + near.loads[1] + ball.centrifugal + 1e-6;
        assert!(near.force.iter().chain(&near.place).all(|v| v.is_finite()));
        // What is left of a balance is rounding, which moves a ball along its grooves, where micronewtons hold it softly: 3e-11 N was seen.
        assert!(
            (near.force - other.force).norm() < 1e-7 * size + 1e-10,
            "{ball:?} {c}: {:?} {:?}",
            near,
            other
        );
        // The ball is in balance.
        let normals = [(near.place - c).normalize(), near.place.normalize()];
        let left =
            Vector2::new(0.0, ball.centrifugal) - normals[0] * near.loads[0] - normals[1] * near.loads[1]
                + near.friction[0]
                + near.friction[1];
        let free = near.loads[0] == 0.0 && ball.centrifugal == 0.0;
        // Places are rounded: some 1e-19 m times a stiffness.
        assert!(free || left.norm() < 1e-9 * size + 1e-12, "{ball:?} {c}: {left} {near:?}");
    }
}
