//! A roller bearing without states: the sum over its rollers, between a shaft and what its outer ring sits in.
//!
//! A roller at azimuth `psi` sees of the shaft's displacement `d` (to first order in its tilt, as all links do)
//!
//! ```text
//! u = y cos + z sin,   t = rz cos - ry sin,   p = (x - R t, u, t)        R the radius of the circle of roller centres
//! f = J^T F,   J = dp/dd,   F on the inner race in the roller's plane
//! ```
//! `psi` turns with the shaft at the kinematic speed of the cage, so that `V` is a potential of `d` alone: what the shaft does against the rollers is
//! stored, also as they pass. Its second derivatives are exact, those by the turn with them. Where the outer ring turns, too, the turn of `d` is what
//! the inner one would need to turn the cage as far ([`Rollers::share_of_outer`]).

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::LinkForce;
use super::roller::{Line, Profile, Rib, Roller, Settled};
use super::roller_friction::{Friction, FrictionOutputs};
use crate::effects::rating::line_contact::{LAMINAE, Laminae, Ratings, place_of};
use crate::model::balance::may_be_left;
use crate::numerics::elementary::pow;
use crate::numerics::size::larger;

/// [kg/m3] density of bearing steel.
const DENSITY: f64 = 7800.0;
/// \[Pa] contact modulus of two bodies of bearing steel, 206 GPa and 0.3.
const CONTACT_MODULUS: f64 = 0.5 * 206e9 / (1.0 - 0.3 * 0.3);
/// \[Pa] pressure of a line contact that leaves a mark (ISO 76).
const STATIC_PRESSURE: f64 = 4e9;
/// [-] static safety that is reported at most.
const SAFEST: f64 = 1e6;
/// [-] place of the contact of a roller's end with a rib from the roller's axis, over the diameter, and radius of a punch that is as stiff,
/// over the diameter: estimates.
const RIB_PLACE: f64 = 0.45;
const RIB_RADIUS: f64 = 0.05;

/// What a roller bearing of one row is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// [-] rollers.
    pub count: usize,
    /// \[m] their diameter.
    pub diameter: f64,
    /// \[m] their effective length.
    pub length: f64,
    /// \[m] diameter of the circle of their centres.
    pub pitch_diameter: f64,
    /// \[m] play of the shaft across the axis, from end to end; negative is a preload.
    pub diametral_clearance: f64,
    /// How their lines fall off.
    pub profile: Profile,
    /// Do ribs take forces of the shaft along +x, along -x?
    pub ribs: [bool; 2],
    /// \[m] play of the shaft along the axis between ribs, from end to end.
    pub axial_clearance: f64,
    /// [N/m] stiffness of a roller between two ribs; an estimate if not given.
    pub rib_stiffness: Option<f64>,
    /// \[rad] azimuth of the first roller at the start.
    pub first_azimuth: f64,
    /// Taper; none of cylindrical rollers.
    pub taper: Option<Taper>,
}

/// Taper of a bearing: its inner ring has one rib, at the large ends of the rollers. Their centres are in the middle of the bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    /// \[rad] angle between the axis and the line on the outer race: the contact angle.
    pub contact_angle: f64,
    /// \[rad] angle between both lines of a roller.
    pub roller_angle: f64,
    /// Does a force of the shaft along +x press the inner ring into the outer one (1), or one along -x (-1)?
    pub direction: f64,
}

impl Geometry {
    /// [-] diameter of the rollers over that of the circle of their centres, with the cosine of the contact angle.
    pub(super) fn gamma(&self) -> f64 {
        self.diameter * self.cosine() / self.pitch_diameter
    }

    /// [-] cosine of the contact angle.
    fn cosine(&self) -> f64 {
        self.taper.map_or(1.0, |taper| taper.contact_angle.cos())
    }

    fn roller(&self, stations: Option<usize>) -> Roller {
        let Self { diameter, length, axial_clearance, .. } = *self;
        let line = |side: f64, angle: f64| Line {
            normal: Vector3::new(angle.sin(), angle.cos(), 0.0) * side,
            side,
            gap: 0.25 * self.diametral_clearance,
            stiffness: Roller::line_stiffness(length),
        };
        // Both ends of a roller in series; each is twice as stiff.
        let stiffness = 2.0 * self.rib_stiffness.unwrap_or(CONTACT_MODULUS * RIB_RADIUS * diameter);
        let lever = RIB_PLACE * diameter;
        let ways = self.ribs.into_iter().zip([1.0, -1.0]).filter(|(taken, _)| *taken);
        let ribs = ways.flat_map(|(_, sign)| {
            [-sign, sign].into_iter().enumerate().map(move |(race, out)| Rib {
                race,
                normal: Vector3::new(out, 0.0, -sign * lever),
                gap: 0.25 * axial_clearance,
                stiffness,
            })
        });
        let mut ribs: Vec<Rib> = ribs.collect();
        let mut angles = [0.0; 2];
        if let Some(Taper { contact_angle, roller_angle, direction }) = self.taper {
            angles = [contact_angle - roller_angle, contact_angle].map(|angle| direction * angle);
            let (sine, cosine) = (contact_angle - 0.5 * roller_angle).sin_cos();
            let normal = Vector3::new(-direction * cosine, sine, -direction * lever);
            ribs.push(Rib { race: 0, normal, gap: 0.0, stiffness });
        }
        let lines = [line(-1.0, angles[0]), line(1.0, angles[1])];
        Roller::new(lines, ribs, [diameter, length], self.profile, stations)
    }
}

/// A roller bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Rollers {
    geometry: Geometry,
    roller: Roller,
    /// \[kg] mass of a roller.
    mass: f64,
    /// [-] speed of the cage over that of the shaft.
    ratio: f64,
    /// Ratings.
    ratings: Ratings,
    /// [N s/m, N s/m, N m s/rad] damping across the axis, along it, and of a tilt.
    pub damping: [f64; 3],
    /// Friction; none where nothing is said of it.
    pub friction: Option<Box<Friction>>,
    /// \[m, rad] where the shaft is while it is in the middle.
    pub rest: Vector6<f64>,
}

/// What a roller bearing does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RollerOutputs {
    /// \[N] largest load of a roller on the inner race.
    pub largest_load: f64,
    /// \[Pa] largest pressure of a line contact.
    pub peak_pressure: f64,
    /// [-] rollers that the inner race presses.
    pub loaded: usize,
    /// \[N] largest force of a rib on the end of a roller.
    pub largest_rib_load: f64,
    /// [million revolutions] reference life under these loads.
    pub life: f64,
    /// \[N] equivalent load of that.
    pub equivalent_load: f64,
    /// [-] load that leaves a mark over the load at the largest pressure.
    pub static_safety: f64,
    /// Stiffness [N/m, N, N m]: force and moment against displacement and rotation of the shaft, in its axes.
    pub stiffness: Matrix6<f64>,
    /// Friction and films; none where nothing is said of them.
    pub friction: Option<FrictionOutputs>,
}

/// A roller as it was left: where it is looked for next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// \[m, m, rad] its motion in its plane.
    pub place: Vector3<f64>,
    /// \[m, m, rad] that of the inner race.
    pub race: Vector3<f64>,
    /// Derivative of its motion by that of the inner race.
    pub follows: Matrix3<f64>,
}

/// A roller of a bearing at a displacement.
struct Seen {
    cosine: f64,
    sine: f64,
    /// Motion of the inner race in its plane.
    moved: Vector3<f64>,
    settled: Settled,
}

impl Rollers {
    /// A bearing; its dynamic load rating \[N] by ISO 281 if not given.
    pub fn new(geometry: Geometry, dynamic_load_rating: Option<f64>) -> Self {
        Self::with_stations(geometry, dynamic_load_rating, None)
    }

    /// What it was made with.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The same with so many stations along a line.
    pub fn with_stations(
        geometry: Geometry,
        dynamic_load_rating: Option<f64>,
        stations: Option<usize>,
    ) -> Self {
        let Geometry { count, diameter, length, pitch_diameter, .. } = geometry;
        Self {
            roller: geometry.roller(stations),
            mass: DENSITY * 0.25 * PI * diameter * diameter * length,
            ratio: 0.5 * (1.0 - geometry.gamma()),
            ratings: Ratings::new(
                count,
                [diameter, length, pitch_diameter],
                geometry.cosine(),
                dynamic_load_rating,
            ),
            damping: [0.0; 3],
            friction: None,
            rest: Vector6::zeros(),
            geometry,
        }
    }

    /// Do ribs hold the shaft along the axis, one way at least?
    pub fn has_ribs(&self) -> bool {
        !self.roller.ribs.is_empty()
    }

    /// [-] its rollers.
    pub fn count(&self) -> usize {
        self.geometry.count
    }

    /// Its ratings.
    pub fn ratings(&self) -> &Ratings {
        &self.ratings
    }

    /// [-] speed of the cage over that of the shaft.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// [-] share of the turn of the outer ring, where that turns, in that of a displacement. The cage turns by `k theta_i + (1 - k) theta_o` with its
    /// ratio `k`, which is `k (theta_i - share theta_o)`.
    pub fn share_of_outer(&self) -> f64 {
        1.0 - 1.0 / self.ratio
    }

    /// [rad/s] speed of the inner ring against the outer one, of a rate of a displacement.
    pub fn relative_speed(&self, rate: &Vector6<f64>, outer: Option<f64>) -> f64 {
        outer.map_or(rate[3], |outer| rate[3] + (self.share_of_outer() - 1.0) * outer)
    }

    /// Does the load go around the inner and the outer ring? It stands still in space, as does an outer ring that is on no shaft.
    fn turning(&self, rate: &Vector6<f64>, outer: Option<f64>) -> [bool; 2] {
        outer.map_or([true, false], |outer| [rate[3] + self.share_of_outer() * outer != 0.0, outer != 0.0])
    }

    /// \[rad/s] at which rollers pass a place while the shaft turns at a rate [rad/s].
    pub fn passing(&self, rate: f64) -> f64 {
        self.geometry.count as f64 * self.ratio * rate
    }

    /// \[N] centrifugal force of a roller while the shaft turns at a rate [rad/s], and its derivative by that.
    fn centrifugal(&self, rate: f64) -> [f64; 2] {
        let over_rate = self.mass * 0.5 * self.geometry.pitch_diameter * self.ratio * self.ratio;
        [over_rate * rate * rate, 2.0 * over_rate * rate]
    }

    /// Every roller at a displacement from the middle, under a centrifugal force \[N], from where they were left, if that is known.
    fn each(&self, d: &Vector6<f64>, centrifugal: f64, left: &[Left]) -> impl Iterator<Item = Seen> {
        let orbit = 0.5 * self.geometry.pitch_diameter;
        let first = self.geometry.first_azimuth + self.ratio * d[3];
        let [x, y, z, tilt_y, tilt_z] = [d[0], d[1], d[2], d[4], d[5]];
        (0..self.geometry.count).map(move |index| {
            let (sine, cosine) = (first + TAU * index as f64 / self.geometry.count as f64).sin_cos();
            let tilt = tilt_z * cosine - tilt_y * sine;
            let moved = Vector3::new(x - orbit * tilt, y * cosine + z * sine, tilt);
            let about = left.get(index).map(|left| left.place + left.follows * (moved - left.race));
            Seen { cosine, sine, moved, settled: self.roller.settle(&moved, centrifugal, about) }
        })
    }

    /// Force and moment on the shaft.
    pub fn force(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>) -> LinkForce {
        self.force_near(displacement, rate, &[])
    }

    /// The same, with rollers sought from where they were left.
    pub fn force_near(&self, displacement: &Vector6<f64>, rate: &Vector6<f64>, left: &[Left]) -> LinkForce {
        self.sum((displacement, rate), left, self.friction.as_deref(), &mut |_| {})
    }

    /// The same, and where rollers are then.
    pub fn leave(
        &self,
        displacement: &Vector6<f64>,
        rate: &Vector6<f64>,
        left: &[Left],
    ) -> (LinkForce, Vec<Left>) {
        let mut now = Vec::with_capacity(self.geometry.count);
        let on =
            self.sum((displacement, rate), left, self.friction.as_deref(), &mut |roller| now.push(roller));
        (on, now)
    }

    /// Force and moment of all rollers on the shaft, and what friction and dampers add; `see` is told of where each roller is.
    fn sum(
        &self,
        (displacement, rate): (&Vector6<f64>, &Vector6<f64>),
        left: &[Left],
        friction: Option<&Friction>,
        see: &mut dyn FnMut(Left),
    ) -> LinkForce {
        let d = displacement - self.rest;
        let orbit = 0.5 * self.geometry.pitch_diameter;
        let [centrifugal, by_rate] = self.centrifugal(rate[3]);
        let mut on = LinkForce::none();
        let mut turning = friction.map(|friction| friction.at(rate[3]));
        for Seen { cosine: c, sine: s, moved, settled } in self.each(&d, centrifugal, left) {
            see(Left { place: settled.place, race: moved, follows: settled.follows });
            // Motion of a race in the plane by the displacement, and the same by the azimuth.
            let plane = |c: f64, s: f64| {
                Matrix3x6::from_rows(&[
                    [1.0, 0.0, 0.0, 0.0, orbit * s, -orbit * c].into(),
                    [0.0, c, s, 0.0, 0.0, 0.0].into(),
                    [0.0, 0.0, 0.0, 0.0, -s, c].into(),
                ])
            };
            let mut by_ring = plane(c, s);
            let mut turned = plane(-s, c) * self.ratio;
            turned[(0, 0)] = 0.0;
            by_ring.set_column(3, &(turned * d));
            let force = &settled.force;
            let mut tangent = -(by_ring.tr_mul(&(settled.stiffness * by_ring)));
            let across = turned.tr_mul(force);
            let mut column = tangent.column_mut(3);
            column += across;
            let mut row = tangent.row_mut(3);
            row += across.transpose();
            // Twice by the azimuth a motion across the axis is its opposite.
            let bent = Vector3::new(orbit * moved.z, -moved.y, -moved.z) * (self.ratio * self.ratio);
            tangent[(3, 3)] += force.dot(&bent);
            on.force += by_ring.tr_mul(force);
            on.by_displacement += tangent;
            let mut column = on.by_rate.column_mut(3);
            column += by_ring.tr_mul(&settled.by_centrifugal) * by_rate;
            if let Some(turning) = &mut turning {
                let (by_force, by_thrown) = turning.add(force, centrifugal);
                let by_rate = (by_force.dot(&settled.by_centrifugal) + by_thrown) * by_rate;
                turning.follow(&-by_ring.tr_mul(&settled.stiffness.tr_mul(&by_force)), by_rate);
            }
            on.stored += settled.stored;
            on.unbalanced = larger(
                on.unbalanced,
                settled.unbalanced / may_be_left([settled.loads[0] + settled.rib, settled.loads[1]]),
            );
        }
        let [radial, axial, tilt] = self.damping;
        let damping = Vector6::new(axial, radial, radial, 0.0, tilt, tilt);
        on.force -= damping.component_mul(rate);
        on.by_rate -= Matrix6::from_diagonal(&damping);
        on.damped = damping.dot(&rate.component_mul(rate));
        if let Some(turning) = turning {
            turning.put(&mut on);
        }
        on
    }

    /// What it does there, with rollers sought from where they were left, and the speed [rad/s] of an outer ring on a shaft: loads, pressures and
    /// life by laminae.
    pub fn outputs(
        &self,
        displacement: &Vector6<f64>,
        rate: &Vector6<f64>,
        left: &[Left],
        outer: Option<f64>,
    ) -> RollerOutputs {
        let Geometry { diameter, length, profile, .. } = self.geometry;
        let stiffness = -self.sum((displacement, rate), left, None, &mut |_| {}).by_displacement;
        let mut of = RollerOutputs { static_safety: SAFEST, stiffness, ..RollerOutputs::default() };
        let mut laminae = Laminae::new(self.turning(rate, outer));
        let [centrifugal, _] = self.centrifugal(rate[3]);
        let mut turning = self.friction.as_deref().map(|friction| friction.at(rate[3]));
        let mut pressed = vec![];
        let stiffness = self.roller.lines[0].stiffness;
        // [1/m] curvatures of roller and race together.
        let curvatures =
            [1.0 - self.geometry.gamma(), 1.0 + self.geometry.gamma()].map(|of| 2.0 / (diameter * of));
        for Seen { moved, settled, .. } in self.each(&(displacement - self.rest), centrifugal, left) {
            let load = settled.loads[0];
            of.largest_load = of.largest_load.max(load);
            of.largest_rib_load = of.largest_rib_load.max(settled.rib);
            of.loaded += usize::from(load > 0.0);
            if let Some(turning) = &mut turning {
                turning.add(&settled.force, centrifugal);
                pressed.push(settled.loads);
            }
            for lamina in 0..LAMINAE {
                let place = place_of(lamina, length);
                let drop = profile.drop(place, diameter, length);
                let approaches = self.roller.approaches([&settled.place, &moved], place, drop);
                let loads = approaches.map(|of| if of > 0.0 { stiffness * pow(of, 10.0 / 9.0) } else { 0.0 });
                laminae.add(lamina, loads.map(|load| load / LAMINAE as f64));
                for (load, curvature) in loads.into_iter().zip(curvatures) {
                    let pressure = (load / length * CONTACT_MODULUS * curvature / PI).sqrt();
                    of.peak_pressure = of.peak_pressure.max(pressure);
                }
            }
        }
        of.friction = turning.map(|turning| {
            let [film, film_ratio] = turning.least_films(&pressed).unwrap_or_default();
            FrictionOutputs { film, film_ratio, ..turning.outputs() }
        });
        of.life = self.ratings.life(&laminae);
        of.equivalent_load = self.ratings.equivalent_load(of.life);
        if of.peak_pressure > 0.0 {
            let over = STATIC_PRESSURE / of.peak_pressure;
            of.static_safety = (over * over).min(SAFEST);
        }
        of
    }
}
