//! The two races of a bearing.

/// A race.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Race {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
}

impl Race {
    /// Both, in the order of every list.
    pub const BOTH: [Self; 2] = [Self::Inner, Self::Outer];

    /// First part of the names of its variables and of its section in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inner => "inner",
            Self::Outer => "outer",
        }
    }
}
