//! Columns that a table of results does not have and the page needs: motion of every body for the playback, ellipses, parts of the power,
//! steps, frequencies. Of at most about a thousand rows of a run.

use nalgebra::Vector3;
use roulement::effects::CONTACT_POWERS;
use roulement::model::bodies::Race;
use roulement::numerics::motion::Pose;
use roulement::simulation::outputs::{BallOutput, ContactOutput, Outputs};

use super::grid::Grid;

/// Columns of these rows.
pub fn columns(rows: &[Outputs]) -> Grid {
    let mut grid = Grid::new(rows.len());
    {
        let mut add = |name: &str, unit: &str, get: &dyn Fn(&Outputs) -> f64| {
            grid.push(name, unit, rows.iter().map(get).collect());
        };
        add("time", "s", &|o| o.time);
        if let Some(first) = rows.first() {
            for race in Race::BOTH {
                pose(&mut add, race.name(), &|o| (&o[race].pose, o[race].turned));
                let name = race.name();
                vector(&mut add, &format!("{name}.force"), "N", &|o| o[race].wrench.force);
                vector(&mut add, &format!("{name}.moment"), "N.m", &|o| o[race].wrench.moment);
            }
            if first.cage.is_some() {
                pose(&mut add, "cage", &|o| {
                    let cage = o.cage.as_ref().expect("a run has a cage in every row or in none");
                    (&cage.pose, cage.turned)
                });
            }
            (0..first.balls.len()).for_each(|ball| of_ball(&mut add, ball, first));
            powers(&mut add, first);
        }
        add("cage.speed", "rad/s", &|o| o.cage_speed);
        add("friction_torque", "N.m", &|o| o.friction_torque);
        add("frequency.cage", "Hz", &|o| o.frequencies.cage);
        add("frequency.outer", "Hz", &|o| o.frequencies.outer);
        add("frequency.inner", "Hz", &|o| o.frequencies.inner);
        add("frequency.ball", "Hz", &|o| o.frequencies.ball);
        add("energy.stored", "J", &|o| o.stored_energy);
        add("energy.work", "J", &|o| o.work);
        add("energy.dissipated", "J", &|o| o.dissipated);
        add("integrator.steps", "1", &|o| o.statistics.steps as f64);
        add("integrator.rejected_by_error", "1", &|o| o.statistics.rejected_error as f64);
        add("integrator.rejected_by_newton", "1", &|o| o.statistics.rejected_newton as f64);
        add("integrator.newton_iterations", "1", &|o| o.statistics.newton.iterations as f64);
        add("integrator.factorisations", "1", &|o| o.statistics.newton.factorisations as f64);
    }
    grid
}

/// A contact of a ball.
type Contact = fn(&BallOutput) -> &ContactOutput;
type Add<'a> = dyn FnMut(&str, &str, &dyn Fn(&Outputs) -> f64) + 'a;

fn vector(add: &mut Add<'_>, name: &str, unit: &str, get: &dyn Fn(&Outputs) -> Vector3<f64>) {
    for (index, axis) in ["x", "y", "z"].into_iter().enumerate() {
        add(&format!("{name}.{axis}"), unit, &|o| get(o)[index]);
    }
}

/// Place, axis, and the turned angle, which has no limit: rows may be further apart than a turn.
fn pose(add: &mut Add<'_>, name: &str, get: &dyn Fn(&Outputs) -> (&Pose, f64)) {
    vector(add, &format!("{name}.position"), "m", &|o| get(o).0.position);
    vector(add, &format!("{name}.axis"), "1", &|o| get(o).0.orientation * Vector3::x());
    add(&format!("{name}.turned"), "rad", &|o| get(o).1);
}

fn of_ball(add: &mut Add<'_>, ball: usize, first: &Outputs) {
    let name = format!("ball[{}]", ball + 1);
    add(&format!("{name}.azimuth"), "rad", &|o| o.balls[ball].azimuth);
    vector(add, &format!("{name}.position"), "m", &|o| o.balls[ball].position);
    vector(add, &format!("{name}.angular_velocity"), "rad/s", &|o| o.balls[ball].angular_velocity);
    if first.balls[ball].pocket.is_some() {
        add(&format!("{name}.pocket.load"), "N", &|o| o.balls[ball].pocket.map_or(0.0, |pocket| pocket.load));
    }
    let races: [(&str, Contact); 2] = [("inner", |b| &b.inner), ("outer", |b| &b.outer)];
    for (race, contact) in races {
        let mut of = |quantity: &str, unit: &str, get: fn(&ContactOutput) -> f64| {
            add(&format!("{name}.{race}.{quantity}"), unit, &|o| get(contact(&o.balls[ball])));
        };
        of("load", "N", |c| c.load);
        of("contact_angle", "rad", |c| c.contact_angle);
        of("peak_pressure", "Pa", |c| c.peak_pressure);
        of("semi_axis_rolling", "m", |c| c.semi_axis_rolling);
        of("semi_axis_transverse", "m", |c| c.semi_axis_transverse);
        of("power", "W", |c| c.power);
        of("spin_power", "W", |c| c.spin_power);
        of("groove_power", "W", |c| c.groove_power);
    }
}

/// Where the power goes. Parts that a run has not are 0 throughout and take no room.
fn powers(add: &mut Add<'_>, first: &Outputs) {
    let races: [(&str, Contact); 2] = [("inner", |b| &b.inner), ("outer", |b| &b.outer)];
    for (race, contact) in races {
        let mut of = |part: &str, get: fn(&ContactOutput) -> f64| {
            add(&format!("power.{race}.{part}"), "W", &|o| o.contact_power(|ball| get(contact(ball))));
        };
        of("friction", |c| c.power);
        of("spin", |c| c.spin_power);
        for power in CONTACT_POWERS {
            of(power.name, power.get);
        }
    }
    if first.cage.is_some() {
        add("power.pockets", "W", &|o| o.cage.map_or(0.0, |cage| cage.pocket_power));
        add("power.lands", "W", &|o| o.cage.map_or(0.0, |cage| cage.land_power));
    }
    add("power.neighbours", "W", &|o| o.neighbours.map_or(0.0, |balls| balls.power));
    add("power.drag", "W", &|o| o.drag_power);
    add("power.damping", "W", &|o| o.damping_power);
    add("power.friction", "W", &|o| o.friction_power);
}
