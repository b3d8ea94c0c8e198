//! What estimates of effects look at, of a scene: its equilibrium at time 0, or where its loads have a point at which a ball carries
//! load first, with every race at the largest speed of its script. An effect that does not matter then may do at another time of the
//! scripts, so that these are looked at, too.

use crate::contact::shoulder::{largest_share, least_margin};
use crate::effects::estimate::{
    BallEstimate, ContactEstimate, Estimate, Outline, RingEstimate, Verdict, digits,
};
use crate::effects::film::USUAL_DENSITY;
use crate::effects::growth::Warmth;
use crate::effects::growth::rings::Cylinder;
use crate::equilibrium::{
    self, BallEquilibrium, Equilibrium, EquilibriumError, EquilibriumInput, Gyroscopic,
};
use crate::kalker::nonlinear::KalkerError;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::scene::{Drive, Machine, Scene, Schedule};

/// Why nothing is estimated.
#[derive(Clone, Debug, thiserror::Error)]
pub enum EstimateError {
    /// No creep coefficients for the bearing's contacts.
    #[error("no estimates of effects: {0}")]
    Creep(#[from] KalkerError),
    /// There is no equilibrium to look at.
    #[error("no estimates of effects: {0}")]
    Equilibrium(#[from] EquilibriumError),
    /// No ball carries load between the races.
    #[error("no estimates of effects: no ball is loaded at any point of the scene's loads")]
    Unloaded,
}

/// What estimates say, or why nothing.
pub type Verdicts = Result<Vec<Verdict>, EstimateError>;

/// Most times of the scripts that are looked at.
const MOST_TIMES: usize = 24;
/// Times in a period of what swings.
const IN_A_PERIOD: u32 = 8;

/// What estimates say of all effects in a scene: that of the start, or of the first other time of its scripts at which the effect
/// matters.
///
/// # Errors
/// See [`EstimateError`].
pub fn verdicts(scene: &Scene, model: &Model) -> Verdicts {
    let mut verdicts = scene.effects.verdicts(&of(scene, model)?);
    for time in times(scene) {
        // Where there is no equilibrium, the other times tell.
        let Ok(there) = at(scene, model, time) else { continue };
        for new in scene.effects.verdicts(&there).into_iter().filter(|new| new.matters) {
            let same = |old: &&mut Verdict| (old.key, old.subject) == (new.key, new.subject);
            if let Some(old) = verdicts.iter_mut().find(same).filter(|old| !old.matters) {
                let sentence = format!("{}, at {} ms", new.sentence, digits(1e3 * time));
                *old = Verdict { sentence, ..new };
            }
        }
    }
    Ok(verdicts)
}

/// \[s] times at which what acts on the bearing has a kink or an extreme value, growing: a selection that is even, with the least and the
/// largest value of each script, where there are very many.
fn times(scene: &Scene) -> Vec<f64> {
    let duration = scene.load.duration.0;
    let (mut times, mut extremes) = (vec![], vec![]);
    for schedule in schedules(scene) {
        let swings = schedule.shortest_period(duration).into_iter();
        let swings = swings.flat_map(|period| {
            (1..=IN_A_PERIOD).map(move |part| period * f64::from(part) / f64::from(IN_A_PERIOD))
        });
        let mut own: Vec<f64> = schedule.knots(0.0, duration).chain(swings).collect();
        own.push(duration);
        own.retain(|time| *time <= duration);
        let by_value = |a: &&f64, b: &&f64| schedule.at(**a).total_cmp(&schedule.at(**b));
        if schedule.is_scripted() {
            extremes.extend(own.iter().min_by(by_value).into_iter().chain(own.iter().max_by(by_value)));
            times.extend(own);
        }
    }
    let stride = times.len().div_ceil(MOST_TIMES).max(1);
    times.sort_by(f64::total_cmp);
    let mut chosen: Vec<f64> = times.into_iter().step_by(stride).chain(extremes).collect();
    chosen.sort_by(f64::total_cmp);
    chosen.dedup();
    chosen
}

/// Scripts of what acts on the bearing, but for speeds, which are looked at where they are largest.
fn schedules(scene: &Scene) -> impl Iterator<Item = &Schedule> {
    let directions = Race::loaded(scene).directions(scene);
    let given = directions.into_iter().flat_map(|direction| [direction.load, direction.motion]).flatten();
    let machine = Race::loaded(scene).machine(scene);
    let machine = machine.into_iter().flat_map(Machine::schedules);
    let others = [Some(&scene.friction.ball_race), scene.effects.film.schedule()];
    given.chain(machine).chain(others.into_iter().flatten())
}

/// The same of a bearing whose races are where others have put them: in an equilibrium that is given.
///
/// # Errors
/// See [`EstimateError`].
pub fn verdicts_under(scene: &Scene, model: &Model, input: &EquilibriumInput) -> Verdicts {
    let problem = |gyroscopic| EquilibriumInput { gyroscopic, ..input.clone() };
    Ok(scene.effects.verdicts(&under(scene, model, problem)?))
}

/// What they look at.
///
/// # Errors
/// See [`EstimateError`].
pub fn of(scene: &Scene, model: &Model) -> Result<Estimate, EstimateError> {
    let mut found = at(scene, model, 0.0);
    for time in times(scene) {
        if !matches!(found, Err(EstimateError::Unloaded)) {
            break;
        }
        found = at(scene, model, time);
    }
    found
}

/// What they look at, at a time \[s] of the scene's loads.
fn at(scene: &Scene, model: &Model, time: f64) -> Result<Estimate, EstimateError> {
    let speeds = [&scene.load.inner_speed, &scene.load.outer_speed].map(fastest);
    let problem = |gyroscopic| {
        let [inner_speed, outer_speed] = speeds;
        EquilibriumInput { inner_speed, outer_speed, ..EquilibriumInput::at(scene, gyroscopic, time) }
    };
    under(scene, model, problem)
}

/// What they look at, in an equilibrium that depends on how gyroscopic moments are carried.
fn under(
    scene: &Scene,
    model: &Model,
    problem: impl Fn(Gyroscopic) -> EquilibriumInput,
) -> Result<Estimate, EstimateError> {
    // Where friction at the outer race cannot hold the balls, that at both does what it can.
    let input = problem(Gyroscopic::OuterRaceControl);
    let solution = equilibrium::solve(model, &input)
        .or_else(|_| equilibrium::solve(model, &problem(Gyroscopic::Friction)))?;
    let speeds = [input.inner_speed, input.outer_speed];
    let loads = || solution.balls.iter().map(|ball| ball.report.inner_load).filter(|load| *load > 0.0);
    let most = solution.balls.iter().max_by(|a, b| a.report.inner_load.total_cmp(&b.report.inner_load));
    let most = most.filter(|ball| ball.report.inner_load > 0.0).ok_or(EstimateError::Unloaded)?;
    let approaches = |ball: &BallEquilibrium| {
        [ball.report.inner_approach, ball.report.outer_approach].map(|approach| approach.max(0.0))
    };
    let depth = |ball: &BallEquilibrium| approaches(ball).into_iter().sum::<f64>();
    let deepest = solution.balls.iter().max_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap_or(most);
    let contacts = model.contacts(&input.surroundings());
    let distance = |race: Race| {
        let surface = &contacts[race].surface;
        surface.raceway.groove_radius - surface.ball_radius + approaches(deepest)[race as usize]
    };
    let bearing = &model.bearing;
    let places = ellipses(model, &input, &solution);
    let shoulders = |race: Race| {
        let of_race = places.iter().filter(move |place| place.race == race as usize);
        of_race.map(move |place| {
            let (share, margin) = bearing.shoulder(race, place.towards_x, place.estimate.semi_axes[1]);
            (place.estimate.load, share, margin)
        })
    };
    let margin = |race| least_margin(shoulders(race).map(|(load, _, margin)| (load, margin)));
    let share = |race| largest_share(shoulders(race).map(|(load, share, _)| (load, share)));
    let forces = solution.load[..3].iter().map(|force| force * force).sum::<f64>().sqrt();
    let largest = most.report.inner_load;
    let outline = outline(scene);
    Ok(Estimate {
        threshold: scene.effects.auto.threshold(),
        deepest: depth(deepest),
        deepest_ball: BallEstimate {
            loads: [deepest.report.inner_load, deepest.report.outer_load],
            approaches: approaches(deepest),
            angles: [deepest.report.inner_contact_angle, deepest.report.outer_contact_angle],
            distances: Race::BOTH.map(distance),
        },
        loads: [largest, loads().fold(largest, f64::min)],
        contact_angle: most.report.inner_contact_angle,
        centrifugal_force: most.report.centrifugal_force,
        gyroscopic_moment: most.report.gyroscopic_moment,
        ball_radius: bearing.ball.radius,
        orbital_velocity: 0.5 * bearing.pitch_diameter * solution.cage_speed.abs(),
        friction: input.friction,
        saturates: scene.effects.creep.law.saturates(),
        caged: scene.effects.cage.on,
        // Moments load balls, too.
        load: forces.max(largest),
        mass: mass(scene, model),
        stiffness: (0..3).map(|i| solution.stiffness[(i, i)]).fold(0.0, f64::max),
        shoulder_margin: margin(Race::Inner).min(margin(Race::Outer)),
        shoulder_share: share(Race::Inner).max(share(Race::Outer)),
        modulus: 2.0 / bearing.materials.compliance,
        viscosity: scene
            .effects
            .rating
            .section
            .as_ref()
            .and_then(|section| section.viscosity)
            .map(|viscosity| viscosity.0 * USUAL_DENSITY),
        youngs_modulus: scene.race.youngs_modulus.0,
        rings: rings(scene, &outline, speeds),
        outline,
        clearance_change: clearance_change(scene, model, speeds),
        oiled: scene.effects.film.lubrication(0.0) > 0.0,
        oil_conductance: scene.effects.heat_balance.section.as_ref().map_or(0.0, |balance| 3.0 * balance.oil),
        contacts: places.into_iter().map(|place| place.estimate).collect(),
    })
}

/// [rad/s] speed of the largest size in a script.
fn fastest(schedule: &Schedule) -> f64 {
    schedule
        .values()
        .into_iter()
        .fold(0.0, |most: f64, speed| if speed.abs() > most.abs() { speed } else { most })
}

/// A contact and where it is.
struct Place {
    race: usize,
    /// \[rad] contact angle towards the race's +x side.
    towards_x: f64,
    estimate: ContactEstimate,
}

/// All contacts that carry load.
fn ellipses(model: &Model, input: &EquilibriumInput, solution: &Equilibrium) -> Vec<Place> {
    let contacts = model.contacts(&input.surroundings());
    let (radius, pitch) = (model.bearing.ball.radius, model.bearing.pitch_diameter);
    let place = |(ball, of): (usize, &BallEquilibrium), race: Race| {
        let report = &of.report;
        let inner = race == Race::Inner;
        let (load, approach, angle, speed) = if inner {
            (report.inner_load, report.inner_approach, report.inner_contact_angle, input.inner_speed)
        } else {
            (report.outer_load, report.outer_approach, report.outer_contact_angle, input.outer_speed)
        };
        let orbit = of.position.yz().norm();
        // The contact lies inside or outside of the ball's orbit.
        let side = if inner { -1.0 } else { 1.0 };
        let along = -side * angle.cos() / (orbit + side * radius * angle.cos());
        let hertz = contacts[race].shape.hertz(along);
        let groove = contacts[race].surface.raceway.groove_radius;
        let root = approach.max(0.0).sqrt();
        // Angular velocity of the ball against the race, along the axis and radially, then about the normal and across it.
        let (sin, cos) = of.azimuth.sin_cos();
        let turn = [of.angular_velocity.x - speed, of.angular_velocity.y * cos + of.angular_velocity.z * sin];
        let (sine, cosine) = angle.sin_cos();
        (load > 0.0).then(|| Place {
            race: race as usize,
            towards_x: side * angle,
            estimate: ContactEstimate {
                ball,
                race: race as usize,
                load,
                semi_axes: [hertz.semi_axis_rolling * root, hertz.semi_axis_transverse * root],
                curvatures: [1.0 / radius + along, 1.0 / radius - 1.0 / groove],
                bend: 0.25 * (1.0 / radius + 1.0 / groove),
                rolling: turn[0] * cosine - turn[1] * sine,
                spin: turn[0] * sine + turn[1] * cosine,
                rolling_speed: (speed - solution.cage_speed).abs() * (0.5 * pitch + side * radius),
            },
        })
    };
    let balls = || solution.balls.iter().enumerate();
    Race::BOTH
        .into_iter()
        .flat_map(|race| balls().filter_map(move |ball| place(ball, race)).collect::<Vec<_>>())
        .collect()
}

/// \[kg] what weighs on the bearing by itself.
fn mass(scene: &Scene, model: &Model) -> f64 {
    let bodies = [&scene.inner, &scene.outer].into_iter().filter(|race| race.drive == Drive::Wrench);
    let bodies: f64 = bodies.filter_map(|race| race.mass.as_ref()).map(|mass| mass.0).sum();
    let cage = scene.effects.cage.section.as_ref().map_or(0.0, |section| section.mass.0);
    model.bearing.n_balls as f64 * model.bearing.ball.mass + bodies + cage
}

/// Outer dimensions: seats where they are given, usual ones elsewhere.
fn outline(scene: &Scene) -> Outline {
    let bearing = &scene.bearing;
    let usual = Outline::usual(bearing.pitch_diameter.0, bearing.ball_diameter.0);
    let seat = |partner: fn(&crate::effects::growth::Section) -> Option<f64>, usual: f64| {
        scene.effects.growth.section.as_ref().and_then(partner).unwrap_or(usual)
    };
    Outline {
        bore: seat(|section| section.shaft.as_ref().map(|shaft| shaft.diameter.0), usual.bore),
        outside: seat(|section| section.housing.as_ref().map(|housing| housing.diameter.0), usual.outside),
        ..usual
    }
}

fn rings(scene: &Scene, outline: &Outline, speeds: [f64; 2]) -> [RingEstimate; 2] {
    let [inner, outer] = scene.bearing.raceways();
    let bottoms =
        [inner.groove_circle_radius - inner.groove_radius, outer.groove_circle_radius + outer.groove_radius];
    let seats = [0.5 * outline.bore, 0.5 * outline.outside];
    [0, 1].map(|index| {
        let (bottom, seat) = (bottoms[index], seats[index]);
        let cylinder = Cylinder {
            inside: seat.min(bottom),
            outside: seat.max(bottom),
            youngs_modulus: scene.race.youngs_modulus.0,
            poisson_ratio: scene.race.poisson_ratio,
            density: scene.race.density.0,
        };
        RingEstimate {
            spun: cylinder.spun(bottom),
            bottom,
            expansion: scene.race.thermal_expansion.0,
            speed: speeds[index],
        }
    })
}

/// \[m] largest change of the clearance by temperatures and fits, at any time of the script; 0 where nothing grows, none where friction
/// warms it.
fn clearance_change(scene: &Scene, model: &Model, spins: [f64; 2]) -> Option<f64> {
    let (Some(growth), Some(schedules)) = (&model.growth, scene.effects.growth.schedules()) else {
        return Some(0.0);
    };
    if model.heat_balance.is_some() {
        return None;
    }
    let [inner, outer] = scene.bearing.raceways();
    let cold = 2.0
        * (outer.groove_circle_radius + outer.groove_radius - inner.groove_circle_radius
            + inner.groove_radius
            - scene.bearing.ball_diameter.0);
    let knots = schedules.into_iter().flat_map(|schedule| schedule.knots(f64::NEG_INFINITY, f64::INFINITY));
    let change = |time: f64| {
        let rises = scene.effects.growth.rises(time).unwrap_or_default();
        (growth.output(&Warmth { rises, spins }).clearance - cold).abs()
    };
    Some(knots.chain([0.0]).map(change).fold(0.0, f64::max))
}
