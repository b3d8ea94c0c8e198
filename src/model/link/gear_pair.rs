//! Geometry of a pair of outside gears on parallel axes, and the mean stiffness of its teeth.

use nalgebra::Vector3;

/// A gear of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// [-] teeth.
    pub teeth: f64,
    /// [-] profile shift, of the normal module.
    pub profile_shift: f64,
    /// \[m] diameter over the tips; that of teeth of one module above the reference cylinder, shortened to keep the usual play, if not given.
    pub tip_diameter: Option<f64>,
}

/// A pair of gears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearPair {
    /// \[m] normal module.
    pub module: f64,
    /// \[rad] normal pressure angle.
    pub pressure_angle: f64,
    /// \[rad] helix angle of the first gear, positive for right-hand teeth (ISO 21771: 2007); the other has the other hand.
    pub helix_angle: f64,
    /// Both gears.
    pub gears: [Gear; 2],
    /// \[m] centre distance.
    pub centre_distance: f64,
    /// \[m] face width that both have in common.
    pub face_width: f64,
}

/// Involute function.
fn involute(angle: f64) -> f64 {
    angle.tan() - angle
}

impl GearPair {
    fn sum(&self) -> f64 {
        self.gears[0].teeth + self.gears[1].teeth
    }

    fn reference_centre_distance(&self) -> f64 {
        0.5 * self.module * self.sum() / self.helix_angle.cos()
    }

    /// \[rad] transverse pressure angle.
    fn transverse_pressure_angle(&self) -> f64 {
        (self.pressure_angle.tan() / self.helix_angle.cos()).atan()
    }

    /// [-] cosine of the working transverse pressure angle at this centre distance: of one that is none, above 1.
    fn working_cosine(&self) -> f64 {
        self.reference_centre_distance() * self.transverse_pressure_angle().cos() / self.centre_distance
    }

    /// \[rad] working transverse pressure angle; not a number where the axes are too close for the base circles.
    pub fn working_pressure_angle(&self) -> f64 {
        self.working_cosine().acos()
    }

    /// \[rad] helix angle on the base cylinder, with the sign of the first gear.
    pub fn base_helix_angle(&self) -> f64 {
        (self.helix_angle.sin() * self.pressure_angle.cos()).asin()
    }

    /// \[m] pitch radii: they divide the centre distance as the teeth.
    pub fn pitch_radii(&self) -> [f64; 2] {
        self.gears.map(|gear| self.centre_distance * gear.teeth / self.sum())
    }

    /// \[m] base radii.
    pub fn base_radii(&self) -> [f64; 2] {
        let cosine = self.working_cosine();
        self.pitch_radii().map(|radius| radius * cosine)
    }

    /// \[m] normal backlash by the thickness of the teeth, which the profile shifts give; negative where they do not fit.
    pub fn backlash(&self) -> f64 {
        let shifts = self.gears[0].profile_shift + self.gears[1].profile_shift;
        let tight = involute(self.transverse_pressure_angle())
            + 2.0 * shifts * self.pressure_angle.tan() / self.sum();
        let angle = self.working_pressure_angle();
        let circumferential = 2.0 * self.centre_distance * (involute(angle) - tight);
        circumferential * angle.cos() * self.base_helix_angle().cos()
    }

    /// [-] transverse contact ratio (ISO 21771: 2007).
    pub fn contact_ratio(&self) -> f64 {
        let [x1, x2] = self.gears.map(|gear| gear.profile_shift);
        let shortened = (self.centre_distance - self.reference_centre_distance()) / self.module - x1 - x2;
        let base = self.base_radii();
        let part = |index: usize| {
            let gear = self.gears[index];
            let usual = self.module
                * (gear.teeth / self.helix_angle.cos()
                    + 2.0 * (1.0 + gear.profile_shift + shortened.min(0.0)));
            let tip = 0.5 * gear.tip_diameter.unwrap_or(usual);
            (tip * tip - base[index] * base[index]).max(0.0).sqrt()
        };
        let length = part(0) + part(1) - self.centre_distance * self.working_pressure_angle().sin();
        let angle = self.transverse_pressure_angle();
        let pitch = std::f64::consts::PI * self.module / self.helix_angle.cos() * angle.cos();
        length / pitch
    }

    /// [N/m] mean stiffness along the normal of steel gears with solid discs and a basic rack of 1.25 modules: ISO 6336-1: 2006, method B
    /// (its coefficients are quoted from memory, no print was at hand), at 100 N/mm or more; that of the standard is in the transverse plane.
    pub fn mean_stiffness(&self) -> f64 {
        let virtual_teeth = self.gears.map(|gear| gear.teeth / self.helix_angle.cos().powi(3));
        let [z1, z2] = virtual_teeth;
        let [x1, x2] = self.gears.map(|gear| gear.profile_shift);
        // mm um/N
        let compliance = 0.04723 + 0.15551 / z1 + 0.25791 / z2
            - 0.00635 * x1
            - 0.11654 * x1 / z1
            - 0.00193 * x2
            - 0.24188 * x2 / z2
            + 0.00529 * x1 * x1
            + 0.00182 * x2 * x2;
        let degrees = self.pressure_angle.to_degrees();
        let rack = (1.0 + 0.5 * (1.2 - 1.25)) * (1.0 - 0.02 * (20.0 - degrees));
        let single = 0.8 * rack * self.helix_angle.cos() / compliance;
        let mean = single * (0.75 * self.contact_ratio() + 0.25);
        // N/(mm um), over the face width.
        mean * 1e9 * self.face_width / self.base_helix_angle().cos().powi(2)
    }

    /// Normals of both flanks on the first gear, whose axis is along x, where the other one lies along `towards` from it (a unit vector
    /// across x): the first where it drives while it turns about +x, the other where it is driven.
    pub fn normals(&self, towards: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let along = Vector3::x().cross(towards);
        let (sin, cos) = self.working_pressure_angle().sin_cos();
        let (base_sin, base_cos) = self.base_helix_angle().sin_cos();
        let axial = Vector3::x() * base_sin;
        [(-along * cos - towards * sin) * base_cos + axial, (along * cos - towards * sin) * base_cos - axial]
    }
}
