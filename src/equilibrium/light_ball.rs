//! A ball whose balance costs little: two Hertzian forces, and what stays as it is near a place.

use nalgebra::{Matrix2, Matrix2x6, Vector2, Vector3};

use super::EquilibriumInput;
use super::ball::{BallBalance, IDLE_HOLD, Place, Shared, arc_radius};
use crate::contact::ContactModel;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::PerRace;

/// [-] residual of a ball over the forces that are known: what is left is taken out to first order.
const BALL_TOLERANCE: f64 = 1e-9;
/// [-] longest step of a ball over its radius.
const LONGEST: f64 = 0.04;
/// Iterations of one ball.
const ITERATIONS: u32 = 40;

/// Quantities of a ball that stay near its place.
#[derive(Clone, Copy, Debug)]
pub struct Stays {
    /// [N/m^1.5] Hertz stiffness, what spalls take off included.
    stiffness: PerRace<f64>,
    /// \[m] approach beyond that of a torus.
    deeper: PerRace<f64>,
    /// \[N] force beside those of the contacts, axial and radial.
    force: Vector2<f64>,
    /// \[m] where that is so.
    place: Place,
    /// Derivatives of the place of balance by displacements and cage speed.
    pub follows: Matrix2x6<f64>,
}

/// Hertzian force of the inner race on a ball in its azimuthal plane: axial and radial component.
#[derive(Clone, Copy)]
pub struct Held {
    /// \[N] force.
    force: Vector2<f64>,
    /// [N/m] its decrease as the ball moves.
    pub stiffness: Matrix2<f64>,
    /// [N/m] increase of the load as the ball moves.
    pub load_by: Vector2<f64>,
    /// [rad/m] increase of the angle of the normal as the ball moves.
    pub angle_by: Vector2<f64>,
}

/// A ball between the races.
pub struct LightBall<'a> {
    contacts: &'a PerRace<ContactModel<'a>>,
    shared: &'a Shared<f64>,
    /// [-] radial direction of its azimuth.
    pub radial: Vector3<f64>,
    /// \[m] longest step.
    pub longest: f64,
    /// \[N] what balance leaves.
    tolerance: f64,
}

/// Balance of a ball at a place.
pub struct Balance {
    /// \[N] unbalanced force along the coordinates of the place.
    residual: Vector2<f64>,
    /// [N/m] its decrease as these grow.
    pub stiffness: Matrix2<f64>,
    /// Inner contact.
    pub inner: Held,
    /// [-] derivatives of the axial and radial position of the ball by its coordinates.
    pub directions: Matrix2<f64>,
    /// [-] directions that the residual is along.
    pub basis: Matrix2<f64>,
    /// Does the ball touch a race?
    touches: bool,
}

impl<'a> LightBall<'a> {
    /// The ball of an azimuth \[rad] where forces of a size `known` \[N] act.
    pub fn new(
        contacts: &'a PerRace<ContactModel<'a>>,
        shared: &'a Shared<f64>,
        azimuth: f64,
        known: f64,
    ) -> Self {
        let (radial, _) = azimuth_directions(azimuth);
        let longest = LONGEST * contacts.outer.surface.ball_radius;
        Self { contacts, shared, radial, longest, tolerance: BALL_TOLERANCE * known }
    }

    /// Approach \[m] to the torus of the inner race, its gradient, the direction along the groove, and the distance \[m] from the
    /// groove centre.
    #[inline(always)]
    fn inner_approach(&self, at: &Vector2<f64>) -> (f64, Vector2<f64>, Vector2<f64>, f64) {
        let raceway = &self.contacts.inner.surface.raceway;
        let axis = &self.shared.axis;
        let offset = Vector3::x() * at.x + self.radial * at.y - self.shared.position;
        let axial = offset.dot(axis);
        let across = offset - axis * axial;
        let radius = across.norm();
        let by_axial = Vector2::new(axis.x, axis.dot(&self.radial));
        let by_radius = Vector2::new(across.x, across.dot(&self.radial)) / radius;
        let (out, along) = (radius - raceway.groove_circle_radius, axial - raceway.groove_offset);
        let distance = (out * out + along * along).sqrt().max(f64::MIN_POSITIVE);
        let (cos, sin) = (out / distance, along / distance);
        let normal = by_radius * cos + by_axial * sin;
        let along_groove = by_axial * cos - by_radius * sin;
        (distance - arc_radius(&self.contacts.inner), normal, along_groove, distance)
    }

    /// Force of the inner race.
    #[inline(always)]
    fn inner(&self, at: &Vector2<f64>, stays: &Stays) -> Held {
        let (approach, normal, along_groove, distance) = self.inner_approach(at);
        let depth = (approach + stays.deeper.inner).max(0.0);
        let slope = stays.stiffness.inner * depth.sqrt();
        let load = slope * depth;
        Held {
            force: -normal * load,
            stiffness: normal * normal.transpose() * (1.5 * slope)
                + along_groove * along_groove.transpose() * (load / distance),
            load_by: normal * (1.5 * slope),
            angle_by: along_groove / distance,
        }
    }

    /// Centre of the ball and the directions along its coordinates: along the outer groove and away from its centre.
    #[inline(always)]
    fn position(&self, place: &Place) -> (Vector2<f64>, Vector2<f64>, Vector2<f64>) {
        let outer = &self.contacts.outer.surface.raceway;
        let (sin, cos) = (place.x / arc_radius(&self.contacts.outer)).sin_cos();
        let centre = Vector2::new(outer.groove_offset, outer.groove_circle_radius);
        let away = Vector2::new(sin, cos);
        (centre + away * place.y, Vector2::new(cos, -sin), away)
    }

    /// Load of the outer race \[N] and its increase with the distance [N/m].
    #[inline(always)]
    fn outer_load(&self, place: &Place, stays: &Stays) -> (f64, f64) {
        let depth = (place.y - arc_radius(&self.contacts.outer) + stays.deeper.outer).max(0.0);
        let slope = stays.stiffness.outer * depth.sqrt();
        (slope * depth, 1.5 * slope)
    }

    /// Quantities of the whole balance that stay near a place.
    pub fn stays(&self, place: &Place, whole: &BallBalance<f64>) -> Stays {
        let (at, along, away) = self.position(place);
        let (inner_approach, ..) = self.inner_approach(&at);
        let per = |load: f64, contact: f64, stiffness: f64| {
            let depth = contact.max(0.0);
            // A spall lessens the load of a depth.
            if load > 0.0 { load / (depth * depth.sqrt()) } else { stiffness }
        };
        let mut stays = Stays {
            stiffness: PerRace {
                inner: per(whole.inner_load, whole.inner.approach, whole.stiffness.inner),
                outer: per(whole.outer_load, whole.outer.approach, whole.stiffness.outer),
            },
            deeper: PerRace {
                inner: whole.inner.approach - inner_approach,
                outer: whole.outer.approach - (place.y - arc_radius(&self.contacts.outer)),
            },
            force: Vector2::zeros(),
            place: *place,
            follows: Matrix2x6::zeros(),
        };
        let contacts = self.inner(&at, &stays).force - away * self.outer_load(place, &stays).0;
        stays.force = along * whole.residual[0] + away * whole.residual[1] - contacts;
        stays
    }

    /// Balance at a place.
    #[inline(always)]
    fn balance(&self, place: &Place, stays: &Stays) -> Balance {
        let (at, along, away) = self.position(place);
        let inner = self.inner(&at, stays);
        let (outer_load, outer_stiffness) = self.outer_load(place, stays);
        // The outer race pushes straight back along the second coordinate.
        let force = inner.force + stays.force;
        let mut residual = Vector2::new(force.dot(&along), force.dot(&away) - outer_load);
        let l = arc_radius(&self.contacts.outer);
        let directions = Matrix2::from_columns(&[along * (place.y / l), away]);
        let basis = Matrix2::from_columns(&[along, away]);
        let mut stiffness = basis.transpose() * inner.stiffness * directions;
        stiffness[(1, 1)] += outer_stiffness;
        // The directions turn along the groove.
        stiffness[(0, 0)] += force.dot(&away) / l;
        stiffness[(1, 0)] -= force.dot(&along) / l;
        if self.shared.cage_speed == 0.0 {
            residual -= (place - stays.place) * IDLE_HOLD;
            stiffness += Matrix2::identity() * IDLE_HOLD;
        }
        let touches = outer_load > 0.0 || inner.force != Vector2::zeros();
        Balance { residual, stiffness, inner, directions, basis, touches }
    }

    /// Derivatives [1/s] of the ball's own orbital speed by the angles of its inner and outer normal \[rad], and that by its
    /// radius [1/(m s)].
    pub fn orbital_speed_by(&self, input: &EquilibriumInput, there: &BallBalance<f64>) -> [f64; 3] {
        let (inner, outer) = (&there.inner.normal, &there.outer.normal);
        let (inner_cos, inner_sin) = (inner.dot(&there.inner.radial), inner.dot(&self.shared.axis));
        let (outer_cos, outer_sin) = (outer.dot(&there.outer.radial), outer.x);
        let radius = there.centre[1];
        let over = self.contacts.outer.surface.ball_radius / radius;
        let below = 1.0 - inner_cos * outer_cos - inner_sin * outer_sin;
        let ratio = (1.0 + over * inner_cos) / below;
        let slope = ratio * (inner_sin * outer_cos - inner_cos * outer_sin);
        [-over * inner_sin - slope, slope, -over * inner_cos / radius]
            .map(|by| by * (input.inner_speed - input.outer_speed) / below)
    }

    /// Finds the place of balance from `place`, as [`super::ball::settle`] does.
    pub fn settle(&self, place: &mut Place, stays: &Stays) -> Option<Balance> {
        let mut here = self.balance(place, stays);
        let mut shift = 0.0;
        // From a thousandth of the stiffness at a micrometre upwards.
        let scale = 1.5e-3 * stays.stiffness.outer;
        for _ in 0..ITERATIONS {
            if here.residual.norm() <= self.tolerance {
                return Some(here);
            }
            let mut trial = None;
            if let Some(mut step) = solve(&(here.stiffness + Matrix2::identity() * shift), &here.residual) {
                let length = step.norm();
                if length > self.longest {
                    step *= self.longest / length;
                }
                let to = *place + step;
                trial = Some((to, self.balance(&to, stays)));
            }
            match trial {
                Some((to, there))
                    if there.residual.norm() < here.residual.norm() || !(here.touches || there.touches) =>
                {
                    *place = to;
                    here = there;
                    shift = if shift < 1e-3 { 0.0 } else { shift * 0.1 };
                }
                _ => {
                    shift = if shift == 0.0 { 1e-3 * scale } else { shift * 8.0 };
                    if shift > 1e9 * scale {
                        return None;
                    }
                }
            }
        }
        None
    }
}

/// Solution of two equations, where it is finite.
pub fn solve(matrix: &Matrix2<f64>, rhs: &Vector2<f64>) -> Option<Vector2<f64>> {
    let step = matrix.try_inverse()? * rhs;
    (step.x.is_finite() && step.y.is_finite()).then_some(step)
}
