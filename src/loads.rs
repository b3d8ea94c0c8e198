//! Loads of parts of a machine on their shaft: unbalance and meshes of helical gears.
//!
//! Forces act in a plane across the shaft, `offset` from a point of its axis about which moments are taken. x is the shaft's axis,
//! azimuths and turns count from +y towards +z. Nothing here knows of bearings: all inputs are numbers.

use nalgebra::Vector3;

use crate::numerics::motion::Wrench;

/// Wrench about a point of the axis of a force \[N] that acts at `at` \[m] from there.
pub fn about_origin(force: Vector3<f64>, at: &Vector3<f64>) -> Wrench {
    Wrench { force, moment: at.cross(&force) }
}

/// Unit vectors away from the axis at an azimuth \[rad], and along growing azimuth.
fn directions(azimuth: f64) -> [Vector3<f64>; 2] {
    let (sin, cos) = azimuth.sin_cos();
    [Vector3::new(0.0, cos, sin), Vector3::new(0.0, -sin, cos)]
}

/// Wrench of a force \[N] that points away from the axis at an azimuth \[rad], in the plane at `offset` \[m]. Its line meets the
/// axis.
pub fn radial_force(force: f64, azimuth: f64, offset: f64) -> Wrench {
    about_origin(directions(azimuth)[0] * force, &(Vector3::x() * offset))
}

/// Wrench of an unbalance [kg m], a mass times its distance from the axis, at an azimuth \[rad] in the plane at `offset` \[m]. The
/// shaft turns at a speed [rad/s] that changes [rad/s2]: the mass pulls outwards, and back against what makes it faster.
pub fn unbalance(product: f64, azimuth: f64, speed: f64, acceleration: f64, offset: f64) -> Wrench {
    let [radial, tangential] = directions(azimuth);
    let force = radial * (product * speed * speed) - tangential * (product * acceleration);
    // The moment about the axis is that of its inertia, which is with the shaft.
    about_origin(force, &(Vector3::x() * offset))
}

/// A mesh of a helical gear on the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh {
    /// \[m] radius of the pitch point.
    pub pitch_radius: f64,
    /// \[rad] pressure angle in the normal section.
    pub pressure_angle: f64,
    /// \[rad] helix angle, positive for right-hand teeth (ISO 21771), where a torque about +x comes with a force along -x. 0 is a spur gear.
    pub helix_angle: f64,
    /// \[rad] azimuth of the pitch point.
    pub position: f64,
    /// \[m] place of the pitch point along x.
    pub offset: f64,
}

impl Mesh {
    /// Components \[N] of the force of a torque [N m] that the mesh exerts on the shaft about +x: along growing azimuth `T/r`,
    /// away from the axis `-|T|/r tan(alpha)/cos(beta)`, and along x `-T/r tan(beta)`.
    pub fn components(&self, torque: f64) -> [f64; 3] {
        let tangential = torque / self.pitch_radius;
        let radial = -tangential.abs() * self.pressure_angle.tan() / self.helix_angle.cos();
        [tangential, radial, -tangential * self.helix_angle.tan()]
    }

    /// Wrench of such a torque [N m], its own moment about x among it.
    pub fn wrench(&self, torque: f64) -> Wrench {
        let [tangential, radial, axial] = self.components(torque);
        let [out, along] = directions(self.position);
        let force = along * tangential + out * radial + Vector3::x() * axial;
        about_origin(force, &(out * self.pitch_radius + Vector3::x() * self.offset))
    }
}

/// How a torque swings as teeth come and go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// [-] teeth of the gear on the shaft.
    pub teeth: f64,
    /// [-] part of the torque that swings.
    pub amplitude: f64,
    /// \[rad] angle of the swing at turn 0.
    pub phase: f64,
}

impl Ripple {
    /// [-] torque over its mean where the shaft has turned by an angle \[rad].
    pub fn factor(&self, turned: f64) -> f64 {
        1.0 + self.amplitude * (self.teeth * turned + self.phase).sin()
    }
}
