//! Mechanics of a bearing's contacts in own formulas, as an oracle: rigid bodies, Hertz, friction, Lundberg. Nothing here
//! calls the code that is tested; creep coefficients are the independent data of tests/data/contact.
#![allow(dead_code)]

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use nalgebra::{UnitQuaternion, Vector3};

pub type V = Vector3<f64>;

/// [s] step of differences in time.
const H: f64 = 1e-7;
/// [m/s] rolling speed is `sqrt(V^2 + this^2)` (docs/model.md).
const SPEED_FLOOR: f64 = 1e-3;

/// A rigid body at one instant, world axes.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub position: V,
    pub orientation: UnitQuaternion<f64>,
    pub velocity: V,
    pub omega: V,
}

impl Body {
    /// After a time [s], in steady motion.
    pub fn after(&self, t: f64) -> Self {
        Self {
            position: self.position + self.velocity * t,
            orientation: UnitQuaternion::new(self.omega * t) * self.orientation,
            ..*self
        }
    }

    pub fn axis(&self) -> V {
        self.orientation * V::x()
    }

    /// Velocity of the body's material at a point of the world.
    pub fn at(&self, point: &V) -> V {
        self.velocity + self.omega.cross(&(point - self.position))
    }
}

/// Young's modulus [Pa] and Poisson's ratio.
pub type Material = (f64, f64);

/// Compliance [1/Pa], shear modulus [Pa], Poisson's ratio of two materials (Kalker 1967).
pub fn pair([(e1, nu1), (e2, nu2)]: [Material; 2]) -> (f64, f64, f64) {
    let (g1, g2) = (e1 / (2.0 + 2.0 * nu1), e2 / (2.0 + 2.0 * nu2));
    let shear = 2.0 * g1 * g2 / (g1 + g2);
    ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2, shear, 0.5 * shear * (nu1 / g1 + nu2 / g2))
}

/// Complete elliptic integrals K and E of a parameter, by the trapezoidal rule, which is exact on a period.
pub fn elliptic(m: f64) -> (f64, f64) {
    let n = 100;
    let root = |i: u32| (1.0 - m * (FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(n)).sin().powi(2)).sqrt();
    let sum = |f: &dyn Fn(f64) -> f64| (0..n).map(|i| f(root(i))).sum::<f64>() * FRAC_PI_2 / f64::from(n);
    (sum(&|r| 1.0 / r), sum(&|r| r))
}

/// A Hertz contact: `Q = stiffness delta^1.5`, semi-axes along x and y `semi[i] Q^(1/3)`.
#[derive(Clone, Copy, Debug)]
pub struct Hertz {
    pub stiffness: f64,
    semi: [f64; 2],
}

impl Hertz {
    /// Relative curvatures [1/m] along x and y.
    pub fn new(curvature: [f64; 2], compliance: f64) -> Self {
        let sum = curvature[0] + curvature[1];
        let (large, small) = (curvature[0].max(curvature[1]), curvature[0].min(curvature[1]));
        // Long over short axis k from ((k^2 + 1) E - 2 K)/((k^2 - 1) E) = difference/sum of curvatures, by bisection.
        let target = (large - small) / sum;
        let of = |k: f64| {
            let (first, second) = elliptic(1.0 - 1.0 / (k * k));
            ((k * k + 1.0) * second - 2.0 * first) / ((k * k - 1.0) * second)
        };
        let (mut low, mut high) = (1.0f64, 60.0f64);
        if target > 1e-9 {
            for _ in 0..56 {
                let middle = 0.5 * (low + high);
                if of(middle) < target { low = middle } else { high = middle }
            }
        } else {
            high = 1.0;
        }
        let k = 0.5 * (low.max(1.0) + high);
        let (first, second) = elliptic(1.0 - 1.0 / (k * k));
        let long = (3.0 * k * k * second * compliance / (PI * sum)).cbrt();
        let short = long / k;
        let approach = 3.0 * compliance * first / (2.0 * PI * long);
        let semi = if curvature[0] > curvature[1] { [short, long] } else { [long, short] };
        Self { stiffness: approach.powf(-1.5), semi }
    }

    pub fn semi_axes(&self, load: f64) -> [f64; 2] {
        self.semi.map(|axis| axis * load.cbrt())
    }
}

/// Creep coefficients C11, C22, C23, C33 of an axis ratio (along over across rolling) and Poisson's ratio, between the
/// independent data: of degree 5 in the logarithm of the ratio, quadratic in Poisson's ratio.
pub fn creep_coefficients(ratio: f64, poisson: f64) -> [f64; 4] {
    static ROWS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
        let text = include_str!("../data/contact/creep_coefficients.csv");
        let row = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
        text.lines().skip(1).map(row).collect()
    });
    let lagrange = |nodes: &[(f64, f64)], x: f64| -> f64 {
        let weight = |i: usize| -> f64 {
            let other = nodes.iter().enumerate().filter(|(j, _)| *j != i);
            other.map(|(_, node)| (x - node.0) / (nodes[i].0 - node.0)).product()
        };
        (0..nodes.len()).map(|i| nodes[i].1 * weight(i)).sum()
    };
    [2, 3, 4, 6].map(|column| {
        let at = |nu: f64| {
            let mut nodes: Vec<(f64, f64)> =
                ROWS.iter().filter(|row| row[0] == nu).map(|row| (row[1].ln(), row[column].ln())).collect();
            nodes.sort_by(|a, b| (a.0 - ratio.ln()).abs().total_cmp(&(b.0 - ratio.ln()).abs()));
            lagrange(&nodes[..6], ratio.ln()).exp()
        };
        lagrange(&[0.25, 0.28, 0.3].map(|nu| (nu, at(nu))), poisson)
    })
}

/// Friction between two surfaces that roll and slide on each other at an ellipse.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// [N] along and across rolling and [N m] about z, on the first body.
    pub forces: [f64; 3],
    /// [-, -, 1/m] creepages: velocities of the first body over the second one's, over the rolling speed.
    pub creepages: [f64; 3],
    /// [W] lost.
    pub power: f64,
}

/// A rolling contact: semi-axes along and across rolling [m], load [N], friction, shear modulus [Pa], coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    pub semi: [f64; 2],
    pub load: f64,
    pub friction: f64,
    pub shear: f64,
    pub c: [f64; 4],
    /// What kind of rolling it is.
    pub kind: Kind,
}

/// Kinds of rolling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// In any direction: coefficients of the same ellipse rolling across.
    Any([f64; 4]),
    /// Near an axis of the ellipse.
    Along,
    /// On a circle: longitudinal and lateral coefficients both their mean, no coupling.
    Round,
}

/// Law `saturated`: linear theory, shortened as a vector of force and moment over their limits by Vermeulen and Johnson.
/// `slip` [m/s, m/s, rad/s] of the first body over the second, along rolling, across, and about z into the first body;
/// `rolling` [m/s] speed at which the contact moves over the surfaces, along and across.
pub fn saturated(patch: &Patch, slip: [f64; 3], rolling: [f64; 2]) -> Friction {
    let [a, b] = patch.semi;
    let c = (a * b).sqrt();
    let [mut c11, mut c22, mut c23, c33] = patch.c;
    if patch.kind == Kind::Round {
        (c11, c22, c23) = (0.5 * (c11 + c22), 0.5 * (c11 + c22), 0.0);
    }
    let speed = (rolling[0].powi(2) + rolling[1].powi(2) + SPEED_FLOOR * SPEED_FLOOR).sqrt();
    let [xi, eta, phi] = slip.map(|slip| slip / speed);
    // Rolling obliquely weakens the coupling by the cosine.
    c23 *= rolling[0] / speed;
    let g = patch.shear;
    let limit = patch.friction * patch.load;
    if limit == 0.0 {
        return Friction { forces: [0.0; 3], creepages: [xi, eta, phi], power: 0.0 };
    }
    let (long, short) = (a.max(b), a.min(b));
    // Hertz's pressure times the distance from the centre, integrated.
    let moment_limit = 0.375 * limit * long * elliptic(1.0 - (short / long).powi(2)).1;
    let q = [
        g * c * c * c11 * xi / limit,
        g * c * c * (c22 * eta + c * c23 * phi) / limit,
        g * c * c * c * (-c23 * eta + c * c33 * phi) / moment_limit,
    ];
    let size = q.iter().map(|q| q * q).sum::<f64>().sqrt();
    let factor = if size < 3.0 { 1.0 - size / 3.0 + size * size / 27.0 } else { 1.0 / size };
    let forces = [-q[0] * factor * limit, -q[1] * factor * limit, -q[2] * factor * moment_limit];
    let power = -(0..3).map(|i| forces[i] * slip[i]).sum::<f64>();
    Friction { forces, creepages: [xi, eta, phi], power }
}

/// The law where rolling is oblique: forces of the ellipse and of the same one rolling across, as `cos^2` to `sin^2 sqrt(a/b)`
/// of the angle; nothing of rolling across below `sin^2 = 0.01`, all of its share from 0.04 on, a cubic between.
pub fn oblique(patch: &Patch, slip: [f64; 3], rolling: [f64; 2]) -> Friction {
    let along = saturated(patch, slip, rolling);
    let Kind::Any(c) = patch.kind else { return along };
    let speed = (rolling[0].powi(2) + rolling[1].powi(2) + SPEED_FLOOR * SPEED_FLOOR).sqrt();
    let square = (rolling[1] / speed).powi(2);
    let t = ((square - 0.01) / 0.03).clamp(0.0, 1.0);
    let cubic = 0.04 * t * t * (3.0 - 2.0 * t) + 0.03 * t * t * (t - 1.0);
    let sine = if t < 1.0 { cubic } else { square };
    let [a, b] = patch.semi;
    let weight = (a / b).sqrt() * sine;
    let share = weight / (1.0 - sine + weight);
    // x of the ellipse rolling across is y here, its y is -x.
    let exchanged = Patch { semi: [b, a], c, ..*patch };
    let across = saturated(&exchanged, [slip[1], -slip[0], slip[2]], [rolling[1], -rolling[0]]);
    let turned = [-across.forces[1], across.forces[0], across.forces[2]];
    let forces = [0, 1, 2].map(|i: usize| along.forces[i] * (1.0 - share) + turned[i] * share);
    let power = -(0..3).map(|i| forces[i] * slip[i]).sum::<f64>();
    Friction { forces, power, ..along }
}

/// A contact between two bodies, all that there is to know.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    pub approach: f64,
    /// [N] without damping, and with.
    pub elastic: f64,
    pub load: f64,
    /// Out of the first body.
    pub normal: V,
    pub point: V,
    /// [m] along and across rolling.
    pub semi: [f64; 2],
    pub friction: Friction,
    /// [N, N m] on the first body, the moment about its centre.
    pub force: V,
    pub moment: V,
    /// [N m] on the second body about its origin.
    pub other_moment: V,
    /// [J, W]
    pub elastic_energy: f64,
    pub damping_power: f64,
}

/// Between a ball and something: `place` gives approach and normal (out of the ball) of both, `curved` the Hertz contact
/// (x along `along`), and `along` the direction near which it rolls.
#[allow(clippy::too_many_arguments)]
pub fn ball_contact(
    [ball, other]: [&Body; 2],
    radius: f64,
    place: &dyn Fn(&Body, &Body) -> (f64, V),
    hertz: &Hertz,
    along: &V,
    (friction, shear, c, kind): (f64, f64, [f64; 4], Kind),
    damping: f64,
) -> Option<Contact> {
    let (approach, normal) = place(ball, other);
    if approach <= 0.0 {
        return None;
    }
    let at = |t: f64| place(&ball.after(t), &other.after(t));
    let rate = (at(H).0 - at(-H).0) / (2.0 * H);
    let elastic = hertz.stiffness * approach.powf(1.5);
    let load = (elastic * (1.0 + damping * rate)).max(0.0);
    let point = ball.position + normal * radius;
    let touched = |t: f64| ball.after(t).position + at(t).1 * radius;
    let moves = (touched(H) - touched(-H)) / (2.0 * H);
    let surfaces = [ball.at(&point), other.at(&point)];
    let rolling = moves - (surfaces[0] + surfaces[1]) * 0.5;
    // Frame C: z into the ball, x along rolling.
    let z = -normal;
    let x = along * if rolling.dot(along) < 0.0 { -1.0 } else { 1.0 };
    let y = z.cross(&x);
    let slip = surfaces[0] - surfaces[1];
    let slips = [slip.dot(&x), slip.dot(&y), (ball.omega - other.omega).dot(&z)];
    let semi = hertz.semi_axes(elastic);
    let patch = Patch { semi, load, friction, shear, c, kind };
    let friction = oblique(&patch, slips, [rolling.dot(&x), rolling.dot(&y)]);
    let tangential = x * friction.forces[0] + y * friction.forces[1];
    let about = z * friction.forces[2];
    let force = z * load + tangential;
    Some(Contact {
        approach,
        elastic,
        load,
        normal,
        point,
        semi,
        friction,
        force,
        moment: (point - ball.position).cross(&force) + about,
        other_moment: -(point - other.position).cross(&force) - about,
        elastic_energy: 0.4 * elastic * approach,
        damping_power: (load - elastic) * rate,
    })
}

/// A raceway: a torus.
#[derive(Clone, Copy, Debug)]
pub struct Groove {
    pub radius: f64,
    pub circle: f64,
    pub offset: f64,
}

/// A bearing in its dimensions.
#[derive(Clone, Copy, Debug)]
pub struct Dimensions {
    pub ball_radius: f64,
    pub grooves: [Groove; 2],
    /// Of balls and races.
    pub materials: [Material; 2],
    pub friction: f64,
    pub damping: f64,
}

/// Grooves of an angular-contact bearing: their centres lie on the line of contact through the ball's centre.
pub fn grooves(diameter: f64, pitch: f64, angle: f64, [inner, outer]: [f64; 2]) -> [Groove; 2] {
    let (sin, cos) = angle.sin_cos();
    let out = |conformity: f64| (conformity - 0.5) * diameter;
    [
        Groove { radius: inner * diameter, circle: 0.5 * pitch + out(inner) * cos, offset: out(inner) * sin },
        Groove {
            radius: outer * diameter,
            circle: 0.5 * pitch - out(outer) * cos,
            offset: -out(outer) * sin,
        },
    ]
}

impl Dimensions {
    /// A ball and a race (0 inner, 1 outer).
    pub fn ball_race(&self, race: usize, ball: &Body, body: &Body) -> Option<Contact> {
        let groove = self.grooves[race];
        let place = |ball: &Body, body: &Body| {
            let seen = body.orientation.inverse() * (ball.position - body.position);
            // The nearest point of the circle of groove centres.
            let around = f64::hypot(seen.y, seen.z);
            let centre =
                V::new(groove.offset, seen.y * groove.circle / around, seen.z * groove.circle / around);
            let out = seen - centre;
            (out.norm() - (groove.radius - self.ball_radius), body.orientation * (out / out.norm()))
        };
        let (_, normal) = place(ball, body);
        let axis = body.axis();
        let offset = ball.position - body.position;
        let radial = (offset - axis * offset.dot(&axis)).normalize();
        let point = offset + normal * self.ball_radius;
        let off_axis = (point - axis * point.dot(&axis)).norm();
        // Meusnier: the race's own curvature around the axis, hollow where the normal points outwards.
        let curvature = 1.0 / self.ball_radius - normal.dot(&radial) / off_axis;
        let across = 1.0 / self.ball_radius - 1.0 / groove.radius;
        let (compliance, shear, poisson) = pair(self.materials);
        let hertz = Hertz::new([curvature, across], compliance);
        let [a, b] = hertz.semi_axes(1.0);
        let across = creep_coefficients(b / a, poisson);
        let law = (self.friction, shear, creep_coefficients(a / b, poisson), Kind::Any(across));
        let along = axis.cross(&radial);
        ball_contact([ball, body], self.ball_radius, &place, &hertz, &along, law, self.damping)
    }
}

/// A cage in its dimensions.
#[derive(Clone, Copy, Debug)]
pub struct CageDimensions {
    pub ball_radius: f64,
    /// Of balls and cage.
    pub materials: [Material; 2],
    pub pocket_clearance: f64,
    pub ball_friction: f64,
    pub land_friction: f64,
    pub damping: f64,
    /// [m] of the circle of pocket centres, where pockets are spheres.
    pub sphere: Option<f64>,
    /// Race (0 inner, 1 outer), diametral clearance, diameter and width of each land [m].
    pub lands: Option<(usize, f64, f64, f64)>,
}

/// On a land: approach, load, force on the cage, its moments about the cage's and the race's origin (on cage, on race),
/// friction, damping, energy.
#[derive(Clone, Copy, Debug)]
pub struct Land {
    pub approach: f64,
    pub load: f64,
    pub force: V,
    pub moment: V,
    pub other_moment: V,
    pub friction_power: f64,
    pub damping_power: f64,
    pub elastic_energy: f64,
}

impl CageDimensions {
    /// Where the ball of an azimuth in the cage [rad] is off its pocket: approach and direction.
    pub fn pocket_place(&self, azimuth: f64, ball: &Body, cage: &Body) -> (f64, V) {
        let seen = cage.orientation.inverse() * (ball.position - cage.position);
        let axis = V::new(0.0, azimuth.cos(), azimuth.sin());
        let off = seen - axis * self.sphere.unwrap_or(seen.dot(&axis));
        (off.norm() - 0.5 * self.pocket_clearance, cage.orientation * off.normalize())
    }

    pub fn pocket(&self, azimuth: f64, ball: &Body, cage: &Body) -> Option<Contact> {
        let place = |ball: &Body, cage: &Body| self.pocket_place(azimuth, ball, cage);
        let (_, normal) = place(ball, cage);
        let axis = cage.orientation * V::new(0.0, azimuth.cos(), azimuth.sin());
        let around = 1.0 / self.ball_radius - 1.0 / (self.ball_radius + 0.5 * self.pocket_clearance);
        let along = if self.sphere.is_some() { around } else { 1.0 / self.ball_radius };
        let (compliance, shear, poisson) = pair(self.materials);
        let hertz = Hertz::new([along, around], compliance);
        let [a, b] = hertz.semi_axes(1.0);
        let kind = if self.sphere.is_some() { Kind::Round } else { Kind::Along };
        let law = (self.ball_friction, shear, creep_coefficients(a / b, poisson), kind);
        // In a sphere any direction will do: the patch is round.
        let along =
            if self.sphere.is_some() { normal.cross(&V::new(0.3, 0.5, -0.7)).normalize() } else { axis };
        ball_contact([ball, cage], self.ball_radius, &place, &hertz, &along, law, self.damping)
    }

    /// The lands at the cage's -x and +x side; without contact all is 0 but the approach.
    pub fn land(&self, cage: &Body, races: &[Body; 2]) -> Option<[Land; 2]> {
        let (race, clearance, diameter, width) = self.lands?;
        let race_body = &races[race];
        let middle = self.ball_radius + 0.5 * self.pocket_clearance + 0.5 * width;
        Some([-middle, middle].map(|along| {
            let section = |cage: &Body, race: &Body| {
                let seen = race.orientation.inverse() * (cage.position + cage.axis() * along - race.position);
                let off = V::new(0.0, seen.y, seen.z);
                (off.norm() - 0.5 * clearance, seen.x, race.orientation * off.normalize())
            };
            let (approach, axial, outwards) = section(cage, race_body);
            let zero = V::zeros();
            let mut land = Land {
                approach,
                load: 0.0,
                force: zero,
                moment: zero,
                other_moment: zero,
                friction_power: 0.0,
                damping_power: 0.0,
                elastic_energy: 0.0,
            };
            if approach > 0.0 {
                // An outer land is touched where the cage went, an inner one opposite.
                let side = if race == 0 { -0.5 } else { 0.5 };
                let point = race_body.position + race_body.axis() * axial + outwards * (side * diameter);
                let slip = cage.at(&point) - race_body.at(&point);
                let rate = slip.dot(&outwards);
                let sliding = slip - outwards * rate;
                // delta = 3.84e-5 Q^0.9/l^0.8 in mm and N (Lundberg)
                let elastic = (1e3 * approach * (1e3 * width).powf(0.8) / 3.84e-5).powf(1.0 / 0.9);
                land.load = (elastic * (1.0 + self.damping * rate)).max(0.0);
                let speed = (sliding.norm_squared() + 1e-4).sqrt();
                let friction = sliding * (-self.land_friction * land.load / speed);
                land.force = friction - outwards * land.load;
                land.moment = (point - cage.position).cross(&land.force);
                land.other_moment = -(point - race_body.position).cross(&land.force);
                land.friction_power = -friction.dot(&sliding);
                land.damping_power = (land.load - elastic) * rate;
                // Energy of Q = k delta^(10/9).
                land.elastic_energy = elastic * approach * 9.0 / 19.0;
            }
            land
        }))
    }
}
