//! What a bearing shows of its state at a communication point.

use nalgebra::{UnitQuaternion, Vector3};

use crate::analysis::condensed::Condensed;
use crate::contact::BallRaceContact;
use crate::contact::body::BodyContact;
use crate::dynamics::state::{RaceState, State, Statistics};
use crate::model::{Constraint, INNER, Model, OUTER, RaceBody, tilt_direction};
use crate::numerics::motion::{Pose, Twist, Wrench};

/// A race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceOutput {
    /// Pose.
    pub pose: Pose,
    /// Twist.
    pub twist: Twist,
    /// What the bearing exerts on the race, about its origin, world axes.
    pub wrench: Wrench,
    /// [N m] torque that keeps a race body at its prescribed speed; for other races, that balances the bearing's.
    pub drive_torque: f64,
    /// What the constraints of a race body exert on it, about its origin, world axes: reactions of held directions and
    /// the drive torque. Zero for other races.
    pub reaction: Wrench,
    /// [rad] turned about the own axis since the start, without limit.
    pub turned: f64,
}

/// A ball-race contact. Longitudinal is along the rolling direction, lateral transverse to it (frame C).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOutput {
    /// [N] normal load.
    pub load: f64,
    /// [rad] contact angle relative to the race; positive under axial load of the inner race along +x.
    pub contact_angle: f64,
    /// [-] longitudinal creepage.
    pub creepage_longitudinal: f64,
    /// [-] lateral creepage.
    pub creepage_lateral: f64,
    /// [1/m] spin creepage.
    pub creepage_spin: f64,
    /// [N] longitudinal creep force on the ball.
    pub force_longitudinal: f64,
    /// [N] lateral creep force on the ball.
    pub force_lateral: f64,
    /// [N m] spin moment on the ball.
    pub spin_moment: f64,
    /// [W] power lost to friction.
    pub power: f64,
    /// [m] semi-axis of the contact ellipse along rolling.
    pub semi_axis_rolling: f64,
    /// [m] semi-axis of the contact ellipse transverse to rolling.
    pub semi_axis_transverse: f64,
    /// [Pa] peak pressure.
    pub peak_pressure: f64,
}

/// A ball's contact with its cage pocket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PocketOutput {
    /// [N] normal load; 0 while they do not touch.
    pub load: f64,
    /// [N] force of the pocket on the ball, world axes.
    pub force: Vector3<f64>,
    /// [m] approach; negative is a gap.
    pub approach: f64,
    /// [W] power lost to friction.
    pub power: f64,
}

/// The cage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageOutput {
    /// Pose.
    pub pose: Pose,
    /// Twist.
    pub twist: Twist,
    /// [m] centre relative to the race that guides the cage (the outer race if the balls do), along that race's axis
    /// (x) and across it (y, z of the frame that tilts with the race but does not spin).
    pub eccentricity: Vector3<f64>,
    /// [rad] turned about the own axis since the start, without limit.
    pub turned: f64,
    /// [N] force of all pockets on the cage, world axes.
    pub pocket_force: Vector3<f64>,
    /// [N] force of the lands on the cage, world axes.
    pub land_force: Vector3<f64>,
    /// [N] normal load on the lands at the cage's -x and +x side.
    pub land_loads: [f64; 2],
    /// [m] deepest approach on the lands; negative is a gap. Minus infinity where the balls guide.
    pub land_approach: f64,
    /// [W] power lost to friction in the pockets.
    pub pocket_power: f64,
    /// [W] power lost to friction on the lands.
    pub land_power: f64,
}

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallOutput {
    /// [rad] azimuth about the outer race's axis, in (-pi, pi].
    pub azimuth: f64,
    /// [rad/s] orbital speed about the outer race's axis.
    pub orbital_speed: f64,
    /// [m] centre, world axes.
    pub position: Vector3<f64>,
    /// [rad/s] angular velocity, world axes.
    pub angular_velocity: Vector3<f64>,
    /// Contact with the inner race.
    pub inner: ContactOutput,
    /// Contact with the outer race.
    pub outer: ContactOutput,
    /// Contact with the cage, where there is one.
    pub pocket: Option<PocketOutput>,
}

/// Everything that is reported of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// [s] time.
    pub time: f64,
    /// Inner race.
    pub inner: RaceOutput,
    /// Outer race.
    pub outer: RaceOutput,
    /// Balls.
    pub balls: Vec<BallOutput>,
    /// The cage, where it is simulated.
    pub cage: Option<CageOutput>,
    /// Stiffness and damping of the running bearing, where they are asked for.
    pub condensed: Option<Condensed>,
    /// [rad/s] spin of the cage about its own axis; without a cage, mean orbital speed of the balls.
    pub cage_speed: f64,
    /// [-] 1 - cage speed over its epicyclic value; 0 where that is 0.
    pub cage_slip: f64,
    /// [W] power lost to friction in all contacts.
    pub friction_power: f64,
    /// [W] power lost to contact damping.
    pub damping_power: f64,
    /// [N m] friction torque of the bearing: against the inner race's rotation about its own axis.
    pub friction_torque: f64,
    /// [J] kinetic and elastic energy.
    pub stored_energy: f64,
    /// [J] work put in since the start.
    pub work: f64,
    /// [J] energy lost since the start to friction and contact damping.
    pub dissipated: f64,
    /// Work of the integrator since the start.
    pub statistics: Statistics,
}

impl Outputs {
    /// Evaluates the outputs of a state at a friction coefficient.
    pub fn new(model: &Model, state: &State, friction: f64) -> Self {
        let contacts = [INNER, OUTER].map(|race| model.contact(race, friction));
        let races = [INNER, OUTER].map(|race| state.races[race].motion());
        let outer = &races[OUTER];
        let (mut friction_power, mut damping_power) = (0.0, 0.0);
        let ball_model = &model.bearing.ball;
        let mut stored_energy = 0.0;
        let mut balls = Vec::with_capacity(state.balls.len());
        let cage = model.cage.as_ref().zip(state.cage.as_ref());
        let cage_motion = state.cage.as_ref().map(RaceState::body_motion);
        let (mut cosine, mut loaded) = (0.0, 0.0);
        for (index, ball) in state.balls.iter().enumerate() {
            let [inner_contact, outer_contact] = [INNER, OUTER].map(|race| {
                let contact = contacts[race].of_ball(state.difference(index, race));
                contact.evaluate(&ball.motion(), &races[race])
            });
            stored_energy += 0.5 * ball_model.mass * ball.velocity.norm_squared()
                + 0.5 * ball_model.inertia * ball.angular_velocity.norm_squared();
            for contact in [&inner_contact, &outer_contact] {
                friction_power += contact.friction_power;
                damping_power += contact.damping_power;
                let depth = contact.geometry.approach.max(0.0);
                stored_energy += 0.4 * contact.stiffness * depth.powf(2.5);
                cosine += contact.load * contact.geometry.normal.dot(&contact.geometry.radial).abs();
                loaded += contact.load;
            }
            let pocket = cage.zip(cage_motion.as_ref()).map(|((cage, _), motion)| {
                let contact = cage.pocket_contact(index, &ball.motion(), motion);
                if let Some(contact) = &contact {
                    friction_power += contact.friction_power;
                    damping_power += contact.damping_power;
                    stored_energy += cage.pocket.elastic_energy(contact.approach);
                }
                PocketOutput {
                    load: contact.map_or(0.0, |contact| contact.load),
                    force: contact.map_or(Vector3::zeros(), |contact| contact.force),
                    approach: cage.pocket_approach(index, &ball.motion(), motion),
                    power: contact.map_or(0.0, |contact| contact.friction_power),
                }
            });
            let frame = state.races[OUTER].pose.orientation.inverse();
            let offset = frame * (ball.position - outer.position);
            let relative = frame * (ball.velocity - outer.velocity);
            let radius_squared = offset.y * offset.y + offset.z * offset.z;
            // The frame of a turning race turns; azimuths are those of a frame that only tilts with it.
            let spin_free = spin_free_azimuth(&state.races[OUTER], &(ball.position - outer.position));
            balls.push(BallOutput {
                azimuth: spin_free,
                orbital_speed: (offset.y * relative.z - offset.z * relative.y) / radius_squared,
                position: ball.position,
                angular_velocity: ball.angular_velocity,
                inner: contact_output(&inner_contact, &races[INNER].axis),
                outer: contact_output(&outer_contact, &races[OUTER].axis),
                pocket,
            });
        }
        let bodies = state.races.iter().zip(model.bodies.iter().map(Option::as_ref));
        for (body_state, body) in bodies.chain(cage.map(|(cage, state)| (state, Some(&cage.body)))) {
            if let Some(body) = body {
                stored_energy += 0.5 * body.mass * body_state.velocity.norm_squared()
                    + 0.5 * body_state.rate.component_mul(&body.inertia).dot(&body_state.rate);
            }
        }
        let mut cage_output = None;
        if let (Some((cage, state_of_cage)), Some(motion)) = (cage, &cage_motion) {
            let lands = cage.land_contacts(motion, races.each_ref());
            for contact in lands.iter().flatten() {
                friction_power += contact.friction_power;
                damping_power += contact.damping_power;
                stored_energy += cage.land.map_or(0.0, |land| land.elastic_energy(contact.approach));
            }
            let guide = cage.land.map_or(OUTER, |land| land.race);
            let output = CageOutput::new(state_of_cage, &state.races[guide], &balls, &lands);
            let approach =
                cage.land.map(|land| land.positions.map(|x| land.approach(motion, &races[guide], x)));
            let land_approach = approach.map_or(f64::NEG_INFINITY, |[a, b]| a.max(b));
            cage_output = Some(CageOutput { land_approach, ..output });
        }
        let mean_orbit = balls.iter().map(|ball| ball.orbital_speed).sum::<f64>() / balls.len() as f64;
        let cage_speed = cage.map_or(mean_orbit, |(_, state)| state.rate.x);
        let contact_angle = if loaded > 0.0 {
            (cosine / loaded).clamp(-1.0, 1.0).acos()
        } else {
            model.bearing.free_contact_angle
        };
        let speeds = [INNER, OUTER].map(|race| state.races[race].rate.x);
        let epicyclic = model.bearing.epicyclic_speed(contact_angle, speeds[INNER], speeds[OUTER]);
        let [inner, outer] = [INNER, OUTER].map(|race| race_output(&state.races[race], model, race));
        Self {
            time: state.time,
            friction_torque: -inner.wrench.moment.dot(&races[INNER].axis) * sign(speeds[INNER]),
            inner,
            outer,
            balls,
            cage: cage_output,
            condensed: model.stiffness_outputs.then(|| Condensed::new(model, state, friction)),
            cage_speed,
            cage_slip: if epicyclic == 0.0 { 0.0 } else { 1.0 - cage_speed / epicyclic },
            friction_power,
            damping_power,
            stored_energy,
            work: state.energies.input,
            dissipated: state.energies.friction + state.energies.damping,
            statistics: state.statistics,
        }
    }
}

impl CageOutput {
    fn new(
        cage: &RaceState,
        guide: &RaceState,
        balls: &[BallOutput],
        lands: &[Option<BodyContact<f64>>; 2],
    ) -> Self {
        let pockets = || balls.iter().filter_map(|ball| ball.pocket);
        Self {
            pose: cage.pose,
            twist: cage.twist(),
            eccentricity: spin_free_frame(guide).inverse() * (cage.pose.position - guide.pose.position),
            turned: cage.turned,
            pocket_force: -pockets().map(|pocket| pocket.force).sum::<Vector3<f64>>(),
            land_force: lands.iter().flatten().map(|contact| contact.force).sum(),
            land_loads: lands.map(|contact| contact.map_or(0.0, |contact| contact.load)),
            land_approach: f64::NEG_INFINITY,
            pocket_power: pockets().fold(0.0, |sum, pocket| sum + pocket.power),
            land_power: lands.iter().flatten().fold(0.0, |sum, contact| sum + contact.friction_power),
        }
    }
}

fn sign(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// Frame that tilts with a race but does not spin.
fn spin_free_frame(race: &RaceState) -> UnitQuaternion<f64> {
    let axis = race.pose.orientation * Vector3::x();
    UnitQuaternion::rotation_between(&Vector3::x(), &axis).unwrap_or_default()
}

/// Azimuth of an offset about the race axis, in the frame that tilts with the race but does not spin.
fn spin_free_azimuth(race: &RaceState, offset: &Vector3<f64>) -> f64 {
    let seen = spin_free_frame(race).inverse() * offset;
    seen.z.atan2(seen.y)
}

fn race_output(race: &RaceState, model: &Model, index: usize) -> RaceOutput {
    let twist = race.twist();
    let axis = race.pose.orientation * Vector3::x();
    let spin = model.bodies[index].as_ref().and_then(|body| {
        body.constraints.iter().position(|constraint| matches!(constraint, Constraint::Spin))
    });
    let drive_torque = match spin {
        Some(index) => race.multipliers[index],
        None => -race.bearing_wrench.moment.dot(&axis),
    };
    let reaction =
        model.bodies[index].as_ref().map_or_else(Wrench::default, |body| reaction(race, body, &axis));
    let wrench = race.bearing_wrench;
    RaceOutput { pose: race.pose, twist, wrench, drive_torque, reaction, turned: race.turned }
}

/// Sum of the multipliers of a race body along their directions.
fn reaction(race: &RaceState, body: &RaceBody, axis: &Vector3<f64>) -> Wrench {
    let mut sum = Wrench::default();
    for (constraint, multiplier) in body.constraints.iter().zip(&race.multipliers) {
        match constraint {
            Constraint::Position(direction, _) => sum.force[*direction] += multiplier,
            Constraint::Tilt(about, _) => sum.moment += tilt_direction(*about, axis) * *multiplier,
            Constraint::Spin => sum.moment += axis * *multiplier,
        }
    }
    sum
}

fn contact_output(contact: &BallRaceContact<f64>, axis: &Vector3<f64>) -> ContactOutput {
    let normal = &contact.geometry.normal;
    // The outer normal points outwards, the inner one inwards: the angle is that of the force on the ball for the
    // inner race, and of its opposite for the outer, so that both are positive under the same thrust.
    let outwards = if normal.dot(&contact.geometry.radial) < 0.0 { -1.0 } else { 1.0 };
    let (axial, radial) = (normal.dot(axis), normal.dot(&contact.geometry.radial));
    let contact_angle = (outwards * axial).atan2(radial.abs());
    // Frame C has x along the rolling direction; the kernel's x is along the circumference.
    let along = if contact.rolling_cosine < 0.0 { -1.0 } else { 1.0 };
    let root = contact.geometry.approach.max(0.0).sqrt();
    let [rolling, transverse] = contact.semi_axes.map(|axis| axis * root);
    let area = std::f64::consts::PI * rolling * transverse;
    ContactOutput {
        load: contact.load,
        contact_angle,
        creepage_longitudinal: along * contact.creepage.longitudinal,
        creepage_lateral: along * contact.creepage.lateral,
        creepage_spin: contact.creepage.spin,
        force_longitudinal: -along * contact.creep.longitudinal,
        force_lateral: -along * contact.creep.lateral,
        spin_moment: -contact.creep.spin_moment,
        power: contact.friction_power,
        semi_axis_rolling: rolling,
        semi_axis_transverse: transverse,
        peak_pressure: if area > 0.0 { 1.5 * contact.load / area } else { 0.0 },
    }
}
