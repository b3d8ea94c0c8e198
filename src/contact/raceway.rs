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
