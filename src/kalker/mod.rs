//! Rolling contact of one elliptical Hertzian patch in Kalker's scaled form.
//!
//! Everything here is free of load, friction and size: with `c = sqrt(a b)` and the peak pressure `p0`,
//! creepages enter as `h = creepage G/(mu p0)` (spin: `spin c G/(mu p0)`) and forces leave as `F/(mu Q)` and
//! `M_z/(mu Q c)`; Kalker's problem then depends on axis ratio, Poisson's ratio and rolling direction alone
//! (Kalker 1967; checked by a test).
//!
//! Signs follow paper eq. 11 and 14: slip `s_x/V = c_x - phi y - kappa y^2`, `s_y/V = c_y + phi x` is the velocity of body 1
//! minus that of body 2, the material flows towards -x (leading edge at +x), and forces are those of body 1 ON
//! BODY 2, so that they point along the creepage. The friction force on body 1 is the opposite.

pub mod creep_coefficients;
pub mod half_space;
pub mod linear;
pub mod load_displacement;
mod minimise;
pub mod nonlinear;
mod objective;
mod objective_weights;
pub mod oblique_net;
pub mod packed;
mod patch;
pub mod scaled_law;
pub mod solution;
pub mod table;
mod table_angle;
mod table_evaluation;
pub mod table_nodes;
mod table_pieces;
mod table_stencil;

pub use patch::{LinearError, Patch};

/// Creepages times `G/(mu p0)`, components along the ellipse axes; the spin times `c` as well.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaledCreepage {
    /// [-] slip of body 1 over body 2 along x, over the rolling speed, times `G/(mu p0)`.
    pub x: f64,
    /// [-] slip along y over the rolling speed, times `G/(mu p0)`.
    pub y: f64,
    /// [-] normal relative angular velocity over the rolling speed, times `c G/(mu p0)`.
    pub spin: f64,
    /// [-] slip `-curvature y^2` along x of a groove that bends across rolling (Heathcote), times `c^2 G/(mu p0)`.
    pub curvature: f64,
}

impl ScaledCreepage {
    /// All of them times a factor.
    pub fn times(&self, factor: f64) -> Self {
        Self {
            x: factor * self.x,
            y: factor * self.y,
            spin: factor * self.spin,
            curvature: factor * self.curvature,
        }
    }
}

/// Net effect of a rolling contact, of body 1 on body 2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaledForces {
    /// [-] force along x over `mu Q`.
    pub fx: f64,
    /// [-] force along y over `mu Q`.
    pub fy: f64,
    /// [-] spin moment over `mu Q c`.
    pub mz: f64,
    /// [-] integral of `y^2` times the traction along x, over `mu Q c^2`: the curvature slip works against it.
    pub second_moment: f64,
}

impl ScaledForces {
    /// [-] dissipated power over `mu Q V` times `G/(mu p0)`, of the contact that rolls at these creepages.
    pub fn power(&self, creepage: &ScaledCreepage) -> f64 {
        creepage.x * self.fx + creepage.y * self.fy + creepage.spin * self.mz
            - creepage.curvature * self.second_moment
    }
}
