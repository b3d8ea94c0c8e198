//! Outputs of a bearing at a communication point.

use std::ops::Index;

use nalgebra::{UnitQuaternion, Vector3};

use super::entering;
use super::losses::{Losses, friction_torque};
use super::margins::Margins;
use super::slip::RollingOrbit;
use crate::contact::{BallRaceContact, ContactModel, RaceMotion};
use crate::effects::Reports;
use crate::effects::film;
use crate::effects::heat::by_part;
use crate::effects::reports::Averaged;
use crate::effects::reports::FilmOutput;
use crate::effects::reports::Frequencies;
use crate::effects::reports::GrowthOutput;
use crate::effects::reports::HeatOutput;
use crate::effects::reports::LifeOutput;
use crate::effects::reports::SupportState;
use crate::effects::reports::Warm;
pub use crate::effects::reports::{
    BallOutput, CageOutput, Condensed, ContactOutput, NeighboursOutput, PocketOutput,
};
use crate::forces::{BallContacts, Contacts, Totals, stored_energy};
use crate::model::bearing;
use crate::model::bodies::{Constraint, PerRace, Race, RigidBody, tilt_direction};
use crate::model::cage::CageModel;
use crate::model::state::{BallState, BodyState, State, Statistics};
use crate::model::{Conditions, Model};
use crate::numerics::motion::{Pose, Twist, Wrench};

/// A race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaceOutput {
    /// Pose.
    pub pose: Pose,
    /// Twist.
    pub twist: Twist,
    /// Force and moment of the bearing on the race, about its origin, world axes; of a race on a support, those of the support on
    /// the flange about the flange's origin.
    pub wrench: Wrench,
    /// [N m] torque that keeps a race that forces move at its prescribed speed; for other races, the torque that balances
    /// the bearing's.
    pub drive_torque: f64,
    /// Force and moment of the constraints on a race that forces move, about its origin, world axes: reactions of held
    /// directions and the drive torque. Zero for other races.
    pub reaction: Wrench,
    /// \[rad] turned about the own axis since the start, without limit.
    pub turned: f64,
}

/// Everything that is reported of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// \[s] time.
    pub time: f64,
    /// Inner race.
    pub inner: RaceOutput,
    /// Outer race.
    pub outer: RaceOutput,
    /// Balls.
    pub balls: Vec<BallOutput>,
    /// The cage, where it is simulated.
    pub cage: Option<CageOutput>,
    /// Contacts of neighbouring balls, where there is no cage.
    pub neighbours: Option<NeighboursOutput>,
    /// Stiffness and damping of the running bearing, where they are asked for.
    pub condensed: Option<Condensed>,
    /// The bearing as it has grown, where growth is simulated.
    pub growth: Option<GrowthOutput>,
    /// Rating life under the loads since the start, where it is asked for.
    pub life: Option<LifeOutput>,
    /// Heat of friction by part, means since the last communication point, where it is reported.
    pub heat: Option<HeatOutput>,
    /// Means since the last communication point, where they are asked for.
    pub means: Option<Averaged>,
    /// Frequencies of cage and damage, by the mean contact angle on the outer race, weighted by load.
    pub frequencies: Frequencies,
    /// [rad/s] spin of the cage about its own axis; without a cage, mean orbital speed of the balls.
    pub cage_speed: f64,
    /// [rad/s] orbital speed of balls that roll without slip at their contact angles on both races, their mean weighted by load.
    pub rolling_speed: f64,
    /// [-] 1 - cage speed over the rolling speed, in [-2, 3]. Its divisor is never less than half of the cage speed, and below 1e-3 m/s
    /// at the pitch radius slip fades to 0: nothing rolls there.
    pub cage_slip: f64,
    /// [-] the same of the balls' own orbital speeds, weighted by load.
    pub ball_slip: f64,
    /// \[W] largest normal load times slip speed of a ball on its way into the load zone; 0 under thrust alone.
    pub entering_slip_load: f64,
    /// \[W] power lost to friction in all contacts.
    pub friction_power: f64,
    /// \[W] power lost to contact damping.
    pub damping_power: f64,
    /// \[W] power that the balls lose to the medium around them.
    pub drag_power: f64,
    /// Losses by part.
    pub losses: Losses,
    /// How far the bearing is from where its run ends.
    pub margins: Margins,
    /// \[W] torque times speed of both races about their own axes: what their rotation puts in.
    pub torque_power: f64,
    /// [Pa s] viscosity of the oil at the inner and at the outer race, where there is oil.
    pub oil: Option<[f64; 2]>,
    /// Temperatures, where the heat of friction gives them.
    pub warm: Option<Warm>,
    /// Flexible supports of inner and outer race, where they rest on some.
    pub supports: [Option<SupportState>; 2],
    /// [N m] friction torque of the bearing: against the rotation of the inner race as seen from the outer one; of an equilibrium, that of its losses.
    pub friction_torque: f64,
    /// \[J] kinetic and elastic energy.
    pub stored_energy: f64,
    /// \[J] work put in since the start.
    pub work: f64,
    /// \[J] what contacts put in whose stiffness changes with the contact angle, since the start; no part of the work.
    pub stiffened: f64,
    /// \[J] energy lost since the start to friction, contact damping, the medium around the balls and dampers of supports.
    pub dissipated: f64,
    /// Work of the integrator since the start.
    pub statistics: Statistics,
}

impl Outputs {
    /// Outputs of a state.
    pub fn new(model: &Model, state: &State, conditions: &Conditions) -> Self {
        Self::of(model, state, &Contacts::new(model, state, conditions), conditions)
    }

    /// Outputs of a state whose contacts were evaluated already.
    pub fn of(model: &Model, state: &State, contacts: &Contacts, conditions: &Conditions) -> Self {
        let totals = Totals::of(contacts, state.balls.len());
        let cage = model.cage.as_ref().zip(state.cage());
        let apart = model.spacing.as_ref().zip(state.spacing.as_ref());
        let outer = state.race(Race::Outer);
        let races = PerRace::new(|race| state.race(race).motion());
        let models = model.contacts_oriented(conditions, state.orientations.as_ref());
        let all = contacts;
        let contacts_of_neighbours =
            |ball: usize| all.ball_pairs.iter().filter(move |pair| [pair.first, pair.second].contains(&ball));
        let to_outer = spin_free_frame(outer).inverse();
        let of_ball = |(index, (ball, contacts)): (usize, (&BallState, &BallContacts))| {
            let offset = ball.position - outer.pose.position;
            let seen = to_outer * offset;
            let held = apart.map(|(spacing, turn)| {
                let force = turn.directions(spacing.azimuths[index]).tangential * turn.pockets[index];
                PocketOutput { load: turn.pockets[index].abs(), force, approach: 0.0, power: 0.0 }
            });
            let pocket = cage.map(|(model, state)| {
                let approach = model.pocket_approach(index, &ball.motion(), &state.body_motion());
                PocketOutput {
                    load: contacts.pocket.map_or(0.0, |pair| pair.load),
                    force: contacts.pocket.map_or(Vector3::zeros(), |pair| pair.force),
                    approach,
                    power: contacts.pocket.map_or(0.0, |pair| pair.friction_power),
                }
            });
            let output = |race: Race| {
                let contact = models[race].of_ball(index, None).completed(
                    &contacts.raceways[race],
                    &ball.motion(),
                    &races[race],
                );
                let output = contact_output(model, race, &contact, &races[race].axis);
                if models[race].resists() { resisted(&models[race], &contact, output) } else { output }
            };
            BallOutput {
                azimuth: seen.z.atan2(seen.y),
                orbital_speed: ball.orbital_speed(outer),
                position: ball.position,
                angular_velocity: ball.angular_velocity,
                spin: along_orbit(&races.outer, &offset, &ball.angular_velocity),
                inner: output(Race::Inner),
                outer: output(Race::Outer),
                pocket: pocket.or(held),
                neighbours_load: contacts_of_neighbours(index)
                    .fold(0.0, |load, pair| pair.forces.load.max(load)),
                neighbours_force: all.neighbours_on(index).map(|wrench| wrench.force).sum(),
            }
        };
        let balls: Vec<_> = state.balls.iter().zip(&contacts.balls).enumerate().map(of_ball).collect();
        let cage_output = cage.map(|(model, cage)| CageOutput::new(model, state, &balls, contacts, cage));
        let mean_orbit = balls.iter().map(|ball| ball.orbital_speed).sum::<f64>() / balls.len() as f64;
        let of_turn = apart.map_or(mean_orbit, |(_, turn)| turn.speed);
        let cage_speed = cage.map_or(of_turn, |(_, state)| state.rate.x);
        let speeds = Race::BOTH.map(|race| state.race(race).rate.x);
        let rolling = RollingOrbit::mean(model, state, contacts, &races, models.inner.surface.ball_radius);
        let frequencies = frequencies(model, &balls, [cage_speed, speeds[0], speeds[1]]);
        let [inner, outer] = Race::BOTH.map(|race| RaceOutput::new(state, model, race));
        let losses = Losses::of(model, state, contacts, (&models, &races), &totals);
        let friction = PerRace::new(|race| models[race].friction);
        let margins = Margins::of(&balls, model.bearing.ball.radius, friction, &state.control);
        Self {
            margins,
            time: state.time,
            torque_power: inner.drive_torque * speeds[0] + outer.drive_torque * speeds[1],
            friction_torque: friction_torque(model, state, || losses),
            inner,
            outer,
            balls,
            cage: cage_output,
            neighbours: neighbours(model, state, contacts),
            condensed: model.stiffness_outputs.then(|| Condensed::new(model, state, conditions)),
            life: model.rating.as_ref().zip(state.rating.as_ref()).map(|(rating, sums)| rating.after(sums)),
            heat: state
                .heat
                .map(|heat| by_part(&heat.mean(state.time), model.cage_guide().map(|race| race as usize))),
            means: state.means.map(|means| means.mean(state.time)),
            growth: model.growth.as_ref().map(|growth| growth.output(&conditions.warmth)),
            frequencies,
            cage_speed,
            rolling_speed: rolling.rolling,
            cage_slip: rolling.slip_of(cage_speed),
            ball_slip: rolling.slip_of(rolling.orbit),
            entering_slip_load: entering::slip_load(state, contacts),
            friction_power: totals.friction_power,
            damping_power: totals.damping_power,
            stored_energy: stored_energy(model, state, contacts),
            work: state.energies.input,
            stiffened: state.energies.stiffened,
            dissipated: state.energies.lost(),
            supports: [state.supports.inner, state.supports.outer],
            warm: state.warm,
            oil: model.films.as_ref().map(|films| {
                [0, 1].map(|race| films.supply(race, conditions.lubrication, &conditions.warmth).viscosity)
            }),
            drag_power: losses.drag,
            losses,
            statistics: state.statistics,
        }
    }
}

impl Outputs {
    /// \[N] normal loads of all contacts with the races.
    pub fn loads(&self) -> impl Iterator<Item = f64> {
        self.balls.iter().flat_map(|ball| [ball.inner.load, ball.outer.load])
    }

    /// \[W] a power of every ball, summed.
    pub fn contact_power(&self, of_ball: impl Fn(&BallOutput) -> f64) -> f64 {
        self.balls.iter().map(of_ball).fold(0.0, |sum, power| sum + power)
    }

    /// Reports of effects.
    pub fn reports(&self) -> Reports<'_> {
        Reports {
            balls: &self.balls,
            cage: self.cage.as_ref(),
            neighbours: self.neighbours.as_ref(),
            condensed: self.condensed.as_ref(),
            growth: self.growth.as_ref(),
            life: self.life.as_ref(),
            heat: self.heat.as_ref(),
            means: self.means.as_ref(),
            frequencies: &self.frequencies,
            drag_power: self.drag_power,
            oil: self.oil,
            warm: self.warm.as_ref(),
            supports: self.supports.each_ref().map(Option::as_ref),
        }
    }
}

impl Index<Race> for Outputs {
    type Output = RaceOutput;
    fn index(&self, race: Race) -> &RaceOutput {
        match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        }
    }
}

impl Index<Race> for BallOutput {
    type Output = ContactOutput;
    fn index(&self, race: Race) -> &ContactOutput {
        match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        }
    }
}

/// Frequencies of cage and damage at speeds of cage, inner and outer race [rad/s].
fn frequencies(model: &Model, balls: &[BallOutput], speeds: [f64; 3]) -> Frequencies {
    let bearing = &model.bearing;
    let (load, cosine) = balls.iter().fold((0.0, 0.0), |(load, cosine), ball| {
        (load + ball.outer.load, cosine + ball.outer.load * ball.outer.contact_angle.cos())
    });
    let cosine = if load > 0.0 { cosine / load } else { bearing.free_contact_angle.cos() };
    Frequencies::new(speeds, balls.len(), 2.0 * bearing.ball.radius / bearing.pitch_diameter, cosine)
}

/// Contacts of neighbouring balls, where no cage keeps them apart.
fn neighbours(model: &Model, state: &State, contacts: &Contacts) -> Option<NeighboursOutput> {
    let contact = model.ball_contact.as_ref()?;
    let gap = |(first, second): (usize, usize)| {
        -contact.approach(&state.balls[first].motion(), &state.balls[second].motion())
    };
    let loads = contacts.ball_pairs.iter().map(|pair| pair.forces.load);
    Some(NeighboursOutput {
        touching: contacts.ball_pairs.len(),
        largest_load: loads.fold(0.0, f64::max),
        gap: bearing::neighbours(state.balls.len()).map(gap).fold(f64::INFINITY, f64::min),
        power: contacts.ball_pairs.iter().fold(0.0, |sum, pair| sum + pair.forces.friction_power),
    })
}

impl CageOutput {
    fn new(
        model: &CageModel,
        state: &State,
        balls: &[BallOutput],
        contacts: &Contacts,
        cage: &BodyState,
    ) -> Self {
        let pockets = || balls.iter().filter_map(|ball| ball.pocket);
        let lands = &contacts.lands;
        let guide = state.race(model.guide().unwrap_or(Race::Outer));
        let approach = model
            .land
            .as_ref()
            .map(|(_, land)| land.positions.map(|x| land.approach(&cage.body_motion(), &guide.motion(), x)));
        Self {
            pose: cage.pose,
            twist: cage.twist(),
            eccentricity: spin_free_frame(guide).inverse() * (cage.pose.position - guide.pose.position),
            turned: cage.turned,
            pocket_force: -pockets().map(|pocket| pocket.force).sum::<Vector3<f64>>(),
            land_force: lands.iter().flatten().map(|pair| pair.force).sum(),
            land_loads: lands.map(|pair| pair.map_or(0.0, |pair| pair.load)),
            land_approach: approach.map_or(f64::NEG_INFINITY, |[a, b]| a.max(b)),
            pocket_power: pockets().fold(0.0, |sum, pocket| sum + pocket.power),
            land_power: lands.iter().flatten().fold(0.0, |sum, pair| sum + pair.friction_power),
        }
    }
}

/// A vector by its components along the axis of a race, radially away from it at an offset \[m] from its origin, and along the
/// circumference there.
fn along_orbit(race: &RaceMotion<f64>, offset: &Vector3<f64>, vector: &Vector3<f64>) -> Vector3<f64> {
    let axis = &race.axis;
    let radial = (offset - axis * offset.dot(axis)).normalize();
    Vector3::new(vector.dot(axis), vector.dot(&radial), vector.dot(&axis.cross(&radial)))
}

/// Frame that tilts with a race but does not spin.
pub(super) fn spin_free_frame(race: &BodyState) -> UnitQuaternion<f64> {
    let axis = race.pose.orientation * Vector3::x();
    UnitQuaternion::rotation_between(&Vector3::x(), &axis).unwrap_or_default()
}

impl RaceOutput {
    /// Output of a race, from the state alone.
    pub(super) fn new(state: &State, model: &Model, race: Race) -> Self {
        let moved = model.bodies[race].as_ref();
        let (wrench, drive_torque) = (state.wrench_on(race), state.drive_torque(moved, race));
        let state = state.race(race);
        let axis = state.pose.orientation * Vector3::x();
        Self {
            pose: state.pose,
            twist: state.twist(),
            wrench,
            drive_torque,
            reaction: moved.map_or_else(Wrench::default, |body| reaction(state, body, &axis)),
            turned: state.turned,
        }
    }
}

/// Sum of the multipliers of a race along their directions.
fn reaction(race: &BodyState, body: &RigidBody, axis: &Vector3<f64>) -> Wrench {
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

/// Sine and cosine, times a length, of the contact angle towards the +x side of a race of this axis, of a contact with this normal and radial
/// direction.
pub(super) fn towards_x(normal: &Vector3<f64>, radial: &Vector3<f64>, axis: &Vector3<f64>) -> (f64, f64) {
    (normal.dot(axis), normal.dot(radial).abs())
}

/// Output with power against rolling and film.
fn resisted(
    model: &ContactModel<'_>,
    contact: &BallRaceContact<f64>,
    output: ContactOutput,
) -> ContactOutput {
    let loading = model.film_loading(contact);
    let film = model.film.map_or(FilmOutput::default(), |of| film::output(&of, &loading));
    ContactOutput { film, resisting_power: model.resisting_power(contact), ..output }
}

/// A contact as it is reported; where grooves face along the axis, the side of the groove does not tell which race it is.
fn contact_output(
    model: &Model,
    race: Race,
    contact: &BallRaceContact<f64>,
    axis: &Vector3<f64>,
) -> ContactOutput {
    let normal = &contact.geometry.normal;
    // The outer normal points outwards, the inner one inwards: the angle is that of the force on the ball for the
    // inner race, and of its opposite for the outer, so that both are positive under the same thrust.
    let (axial, radial) = (normal.dot(axis), normal.dot(&contact.geometry.radial));
    let (sine, cosine) = towards_x(normal, &contact.geometry.radial, axis);
    let towards_x = sine.atan2(cosine);
    let contact_angle = match (model.bearing.is_thrust_bearing(), race) {
        (true, Race::Inner) => (-axial).atan2(-radial),
        (true, Race::Outer) => axial.atan2(radial),
        (false, _) if radial < 0.0 => -towards_x,
        (false, _) => towards_x,
    };
    // Frame C has x along the rolling direction; the kernel's x is along the circumference.
    let along = if contact.rolling_cosine < 0.0 { -1.0 } else { 1.0 };
    let root = contact.geometry.approach.max(0.0).sqrt();
    let [rolling, transverse] = contact.semi_axes.map(|axis| axis * root);
    let area = std::f64::consts::PI * rolling * transverse;
    let (shoulder_share, shoulder_margin) = model.bearing.shoulder(race, towards_x, transverse);
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
        spin_power: contact.creep.spin_moment * contact.creepage.spin * contact.rolling_speed,
        groove_power: contact
            .creepage
            .curvature
            .map_or(0.0, |curvature| -contact.creep.second_moment * curvature * contact.rolling_speed),
        semi_axis_rolling: rolling,
        semi_axis_transverse: transverse,
        shoulder_share,
        shoulder_margin,
        resisting_power: 0.0,
        film: FilmOutput::default(),
        peak_pressure: if area > 0.0 { 1.5 * contact.load / area } else { 0.0 },
    }
}
