//! Rings and shafts as cylinders: how far their surfaces move under pressure and by rotation, and what a fit does to both parts.
//!
//! Plane stress. Pressure after Lame (1852), rotation after Timoshenko and Goodier (Theory of Elasticity, article 32). A ring
//! lies between its seat and the bottom of its raceway: shoulders, which make it some percent stiffer, are left out.

/// A cylinder of one material; a solid one has an inside radius of 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// \[m] radius of the inside surface.
    pub inside: f64,
    /// \[m] radius of the outside surface.
    pub outside: f64,
    /// \[Pa] Young's modulus.
    pub youngs_modulus: f64,
    /// [-] Poisson's ratio.
    pub poisson_ratio: f64,
    /// [kg/m3] density.
    pub density: f64,
}

impl Cylinder {
    /// \[m] radial displacement at a radius \[m] by pressures \[Pa] on its surfaces, inside and outside.
    pub fn pressed(&self, radius: f64, [inside, outside]: [f64; 2]) -> f64 {
        let (a2, b2) = (self.inside * self.inside, self.outside * self.outside);
        let uniform = (1.0 - self.poisson_ratio) * (inside * a2 - outside * b2) * radius;
        let sheared = (1.0 + self.poisson_ratio) * (inside - outside) * a2 * b2 / radius;
        (uniform + sheared) / (self.youngs_modulus * (b2 - a2))
    }

    /// [m s2] radial displacement at a radius \[m] over the square of the speed of rotation [rad/s].
    pub fn spun(&self, radius: f64) -> f64 {
        let (a2, b2, nu) = (self.inside * self.inside, self.outside * self.outside, self.poisson_ratio);
        let inertia = self.density * radius / (8.0 * self.youngs_modulus);
        inertia
            * ((3.0 + nu) * ((1.0 - nu) * (a2 + b2) + (1.0 + nu) * a2 * b2 / (radius * radius))
                - (1.0 - nu * nu) * radius * radius)
    }
}

/// A part on a seat of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The part inside the seat.
    pub inner: Cylinder,
    /// The part around it.
    pub outer: Cylinder,
}

/// Fit in operation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seated {
    /// \[m] diametral interference; negative is a gap.
    pub interference: f64,
    /// \[Pa] pressure on the seat; 0 where there is a gap.
    pub pressure: f64,
}

impl Fit {
    /// \[m] radius of the seat.
    fn seat(&self) -> f64 {
        self.inner.outside
    }

    /// The fit in operation: of an interference \[m] that temperatures have changed already, at the square of a speed [rad2/s2]
    /// that both parts turn at; 0 leaves out what rotation does.
    pub fn seated(&self, interference: f64, square_speed: f64) -> Seated {
        let seat = self.seat();
        let widened = square_speed * (self.inner.spun(seat) - self.outer.spun(seat));
        let interference = interference + 2.0 * widened;
        // Radial displacement of both seats by a unit of pressure.
        let yielding = self.outer.pressed(seat, [1.0, 0.0]) - self.inner.pressed(seat, [0.0, 1.0]);
        Seated { interference, pressure: (0.5 * interference / yielding).max(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel(inside: f64, outside: f64) -> Cylinder {
        Cylinder { inside, outside, youngs_modulus: 206e9, poisson_ratio: 0.3, density: 7800.0 }
    }

    #[test]
    fn closed_form_ring_on_a_solid_shaft_of_the_same_material_grows_by_the_ratio_of_diameters() {
        let (seat, bottom) = (0.015, 0.0182);
        let fit = Fit { inner: steel(0.0, seat), outer: steel(seat, bottom) };
        let seated = fit.seated(20e-6, 0.0);
        assert_eq!(seated.interference, 20e-6);
        let grown = 2.0 * fit.outer.pressed(bottom, [seated.pressure, 0.0]);
        assert!((grown / (20e-6 * seat / bottom) - 1.0).abs() < 1e-13, "{grown}");
        // A gap presses nothing.
        assert_eq!(fit.seated(-1e-9, 0.0).pressure, 0.0);
    }

    #[test]
    fn closed_form_thin_ring_and_solid_disc_in_rotation() {
        // Thin ring: rho w^2 r^3/E.
        let (r, w) = (0.05, 1000.0);
        let thin = steel(r - 1e-6, r);
        let grown = thin.spun(r) * w * w;
        assert!((grown / (7800.0 * w * w * r.powi(3) / 206e9) - 1.0).abs() < 1e-4, "{grown}");
        // Rim of a solid disc: (1 - nu) rho w^2 r^3/(4 E).
        let grown = steel(0.0, r).spun(r) * w * w;
        assert!((grown / (0.7 * 7800.0 * w * w * r.powi(3) / (4.0 * 206e9)) - 1.0).abs() < 1e-13, "{grown}");
    }
}
