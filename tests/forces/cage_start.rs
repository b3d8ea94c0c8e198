//! Where a cage starts: free of its contacts, also in tilted races, or not at all.

use roulement::simulation::Simulation;

use crate::scenes::scene;

const CAGE: &str = include_str!("../../scenes/cage.toml");

/// Grooves that reach to both sides, for tilts at which a ball leaves the loaded one.
const OPEN: [(&str, &str); 2] =
    [("inner.shoulder_angle", "[1.5, 1.5]"), ("outer.shoulder_angle", "[1.5, 1.5]")];

/// The cage scene with its inner race held at a tilt [deg] and a clearance of the pockets [mm], guided by outer race or balls.
fn tilted(degrees: f64, clearance: f64, by_balls: bool) -> Result<Simulation, String> {
    let (tilt, clearance) = (format!("{{ rotation = \"{degrees} deg\" }}"), format!("\"{clearance} mm\""));
    let mut changes = vec![("load.ry", tilt.as_str()), ("cage.pocket_clearance", &clearance)];
    changes.extend(OPEN);
    if by_balls {
        changes.push(("cage.guided_by", "\"balls\""));
        for key in ["cage.guidance_clearance", "cage.land_diameter", "cage.land_width", "friction.cage_race"]
        {
            changes.push((key, ""));
        }
    }
    Simulation::new(&scene(CAGE, &changes)).map_err(|why| why.to_string())
}

/// Largest force on the cage in pockets and lands [N].
fn pressed(simulation: &Simulation) -> f64 {
    let outputs = simulation.outputs();
    let pockets = outputs.balls.iter().map(|ball| ball.pocket.unwrap().load);
    pockets.chain(outputs.cage.unwrap().land_loads).fold(0.0, f64::max)
}

#[test]
fn invariant_a_cage_in_tilted_races_starts_without_contact_forces() {
    for (degrees, clearance, by_balls) in
        [(0.5, 0.1, false), (-0.5, 0.1, true), (0.3, 0.06, false), (1.0, 0.3, true)]
    {
        let mut simulation = tilted(degrees, clearance, by_balls).unwrap();
        let start = pressed(&simulation);
        assert!(start < 5.0, "{degrees} deg, {clearance} mm, by balls: {by_balls}: {start} N at the start");
        for step in 1..=20 {
            simulation.advance(f64::from(step) * 1e-4).unwrap();
            // Balls of tilted races lead and lag, which their pockets feel later.
            assert!(pressed(&simulation) < 1e3, "{degrees} deg, {clearance} mm: {} N", pressed(&simulation));
        }
    }
}

#[test]
fn a_cage_without_room_is_refused_with_its_contact_and_clearance() {
    // Lands of the outer race that keep the cage straight, pockets too narrow for the tilted plane of the balls.
    let changes = [
        ("load.ry", "{ rotation = \"1 deg\" }"),
        ("cage.pocket_clearance", "\"0.06 mm\""),
        ("cage.guidance_clearance", "\"0.05 mm\""),
        OPEN[0],
        OPEN[1],
    ];
    let why = Simulation::new(&scene(CAGE, &changes)).map(|_| ()).unwrap_err().to_string();
    // A pocket and a land are pressed alike where the largest overlap is least: the last digits tell which one is named.
    let land = why.contains("a land of the outer race") && why.contains("5.000e-5 m");
    let pocket = why.contains("the pocket of ball") && why.contains("6.000e-5 m");
    assert!(land || pocket, "{why:?} names neither contact with its clearance");
    for part in ["cage does not fit", "tilt"] {
        assert!(why.contains(part), "{part:?} is not in {why:?}");
    }
}

#[test]
fn regression_a_cage_that_touches_nothing_starts_in_the_middle() {
    let simulation = tilted(0.0, 0.2, false).unwrap();
    let state = simulation.state();
    let cage = state.cage().unwrap();
    let mean = state.balls.iter().map(|ball| ball.position.x).sum::<f64>() / state.balls.len() as f64;
    assert_eq!((cage.pose.position.x, cage.pose.position.y, cage.pose.position.z), (mean, 0.0, 0.0));
    assert_eq!(cage.axes[0].x, 1.0);
}
