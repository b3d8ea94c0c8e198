//! The surface of a race that balls roll on.

/// One raceway: a groove of circular section swept about the race's own x axis (a torus).
///
/// Lengths are in the race frame, whose origin is the bearing centre of the unloaded bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raceway {
    /// \[m] radius of the groove's section.
    pub groove_radius: f64,
    /// \[m] radius of the circle of groove centres.
    pub groove_circle_radius: f64,
    /// \[m] axial position of the groove centres.
    pub groove_offset: f64,
}

/// [-] sine of the free contact angle from which a raceway is that of a thrust bearing: 85.95 degrees.
const STEEP: f64 = 0.9975;

impl Raceway {
    /// Is it the washer of a thrust bearing, whose groove faces along the axis? `ball_radius` \[m].
    pub fn faces_along_axis(&self, ball_radius: f64) -> bool {
        self.groove_offset.abs() > STEEP * (self.groove_radius - ball_radius)
    }
}
