//! A spring that presses one way: a potential with two continuous derivatives.
//!
//! ```text
//! s(x) = 0                 x <= 0
//!        x^2 / (2 w)       0 < x < w          w the way over which it comes in
//!        x - w / 2         x >= w
//! ```
//! Beyond `w` the stiffness is the given one, exactly.

/// \[m] way over which contacts of teeth and rings come in: some tenths of the roughness of their surfaces, small beside their deflections.
pub const ROUGH: f64 = 1e-7;

/// Value, derivatives and integral of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneSided {
    /// \[m] s.
    pub way: f64,
    /// [-] s'.
    pub slope: f64,
    /// [1/m] s''.
    pub curvature: f64,
    /// \[m2] integral of s.
    pub potential: f64,
}

impl OneSided {
    /// At an overlap \[m].
    pub fn at(x: f64) -> Self {
        let w = ROUGH;
        if x <= 0.0 {
            Self { way: 0.0, slope: 0.0, curvature: 0.0, potential: 0.0 }
        } else if x < w {
            Self { way: 0.5 * x * x / w, slope: x / w, curvature: 1.0 / w, potential: x * x * x / (6.0 * w) }
        } else {
            Self { potential: 0.5 * x * x - 0.5 * w * x + w * w / 6.0, ..Self::held(x) }
        }
    }

    /// A contact that never opens, as it is beyond the way over which it comes in.
    pub fn held(x: f64) -> Self {
        let w = ROUGH;
        let potential = 0.5 * (x - 0.5 * w) * (x - 0.5 * w);
        Self { way: x - 0.5 * w, slope: 1.0, curvature: 0.0, potential }
    }

    /// A spring both ways.
    pub fn linear(x: f64) -> Self {
        Self { way: x, slope: 1.0, curvature: 0.0, potential: 0.5 * x * x }
    }
}
