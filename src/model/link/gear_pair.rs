//! Geometry of a pair of gears on parallel axes, and the mean stiffness of its teeth.
//!
//! The signs are those of ISO 21771 (2007): a gear with inside teeth has a negative number of teeth, and with it radii below zero; its pair has a
//! negative centre distance. All formulas hold for both then.

use nalgebra::Vector3;

/// A gear of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// [-] teeth; negative where they are inside.
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
    /// \[rad] helix angle of the first gear, positive for right-hand teeth (ISO 21771: 2007); another outside gear has the other hand, one with inside
    /// teeth the same.
    pub helix_angle: f64,
    /// Both gears.
    pub gears: [Gear; 2],
    /// \[m] centre distance; negative with inside teeth.
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

    /// \[m] pitch radii: they divide the centre distance as the teeth; negative of inside teeth.
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

    /// [-] parts of the transverse contact ratio after the pitch point, where the tip of the first gear carries, and before it (ISO 21771: 2007).
    pub fn tip_ratios(&self) -> [f64; 2] {
        let [x1, x2] = self.gears.map(|gear| gear.profile_shift);
        let shortened = (self.centre_distance - self.reference_centre_distance()) / self.module - x1 - x2;
        let base = self.base_radii();
        let angle = self.transverse_pressure_angle();
        let pitch = std::f64::consts::PI * self.module / self.helix_angle.cos() * angle.cos();
        [0, 1].map(|index| {
            let gear = self.gears[index];
            let usual = self.module
                * (gear.teeth / self.helix_angle.cos()
                    + 2.0 * (1.0 + gear.profile_shift + shortened.min(0.0)));
            let tip = 0.5 * gear.tip_diameter.unwrap_or(usual);
            let way = (tip * tip - base[index] * base[index]).max(0.0).sqrt() * gear.teeth.signum();
            (way - base[index] * self.working_pressure_angle().tan()) / pitch
        })
    }

    /// [-] transverse contact ratio (ISO 21771: 2007).
    pub fn contact_ratio(&self) -> f64 {
        self.tip_ratios().iter().sum()
    }

    /// [-] tooth loss factor: lost power over coefficient of friction and transmitted power (Ohlendorf 1958, as in Niemann and Winter 2003 and
    /// ISO/TR 14179-2: 2001; from memory), for contact ratios of 1 to 2.
    pub fn loss_factor(&self) -> f64 {
        let [one, other] = self.tip_ratios();
        let [z1, z2] = self.gears.map(|gear| gear.teeth);
        let ratio = z2 / z1;
        let shape = 1.0 - one - other + one * one + other * other;
        std::f64::consts::PI * (ratio + 1.0) / (z1 * ratio * self.base_helix_angle().cos()) * shape
    }

    /// [-] turn of the first gear against the line of centres, over the relative rotation of both.
    pub fn turn(&self) -> f64 {
        self.gears[1].teeth / self.sum()
    }

    /// [N/m] mean stiffness along the normal of steel gears with solid discs and a basic rack of 1.25 modules: ISO 6336-1: 2006, method B
    /// (its coefficients are quoted from memory, no print was at hand), at 100 N/mm or more; that of the standard is in the transverse plane. Inside teeth
    /// count as a rack there.
    pub fn mean_stiffness(&self) -> f64 {
        let virtual_teeth = self.gears.map(|gear| gear.teeth / self.helix_angle.cos().powi(3));
        let [z1, z2] = virtual_teeth.map(|teeth| if teeth < 0.0 { f64::INFINITY } else { teeth });
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

    /// Normals of both flanks on the first gear, whose axis is along x, where the pitch point lies along `towards` from it (a unit vector
    /// across x): the first where it drives while it turns about +x, the other where it is driven.
    pub fn normals(&self, towards: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let along = Vector3::x().cross(towards);
        let (sin, cos) = self.working_pressure_angle().sin_cos();
        let (base_sin, base_cos) = self.base_helix_angle().sin_cos();
        let axial = Vector3::x() * base_sin;
        [(-along * cos - towards * sin) * base_cos + axial, (along * cos - towards * sin) * base_cos - axial]
    }
}
