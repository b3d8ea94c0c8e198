//! Stand-in until the solver lands.
use crate::bearing::Bearing;

/// e
#[derive(Debug, thiserror::Error)]
#[error("no equilibrium")]
pub struct EquilibriumError;

/// e
pub struct BallEquilibrium {
    /// e
    pub azimuth: f64,
    /// e
    pub position: (f64, f64),
    /// e
    pub orbital_speed: f64,
    /// e: world components (axial, radial, tangential)
    pub spin: [f64; 3],
}
/// e
pub struct Equilibrium {
    /// e
    pub displacement: [f64; 5],
    /// e
    pub balls: Vec<BallEquilibrium>,
}

/// Pure thrust by bisection.
pub fn thrust(bearing: &Bearing, k: impl Fn(f64) -> f64, force: f64, speed: f64) -> Equilibrium {
    let solve = |x: f64| {
        let (i, o) = (&bearing.inner, &bearing.outer);
        let ax = i.groove_offset + x - o.groove_offset;
        let rad = i.groove_circle_radius - o.groove_circle_radius;
        let l = ax.hypot(rad);
        let free = i.groove_radius + o.groove_radius - 2.0 * bearing.ball.radius;
        let angle = ax.atan2(rad);
        let d = (l - free).max(0.0) / 2.0;
        (
            k(angle) * d.powf(1.5) * bearing.n_balls as f64 * angle.sin(),
            angle,
            d,
        )
    };
    let (mut lo, mut hi) = (0.0, 1e-3);
    for _ in 0..200 {
        let m = 0.5 * (lo + hi);
        if solve(m).0 < force { lo = m } else { hi = m }
    }
    let (_, angle, d) = solve(lo);
    let o = &bearing.outer;
    let l = o.groove_radius - bearing.ball.radius + d;
    let pos = (
        o.groove_offset + l * angle.sin(),
        o.groove_circle_radius + l * angle.cos(),
    );
    let g = bearing.ball.radius * angle.cos() / pos.1;
    let cage = speed * (1.0 - g) / 2.0;
    // ball roll speed, outer race control
    let r = bearing.ball.radius;
    let roll = cage * (pos.1 + r * angle.cos()) / r;
    let spin = [-roll * angle.cos() + cage * 0.0, roll * angle.sin(), 0.0];
    Equilibrium {
        displacement: [lo, 0.0, 0.0, 0.0, 0.0],
        balls: (0..bearing.n_balls)
            .map(|j| BallEquilibrium {
                azimuth: bearing.ball_azimuth(j),
                position: pos,
                orbital_speed: cage,
                spin,
            })
            .collect(),
    }
}
