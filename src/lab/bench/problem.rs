//! The problems and the methods that can move their wire.

/// The problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum Problem {
    /// cantilever under a dead force at its tip
    P1,
    /// cantilever vibration over ten periods of its first mode
    P2,
    /// capstan: half a turn of slipping wire
    P3,
    /// two turns wound on a cylinder
    P4,
    /// free wire: cost of a node and step
    P5,
    /// a whole scene
    W,
}

impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Debug::fmt(self, f)
    }
}

/// Which method moves the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// the production method
    Implicit,
    /// velocity Verlet
    Verlet,
    /// classical Runge-Kutta
    Rk4,
}

impl Method {
    /// Its name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Implicit => "implicit",
            Self::Verlet => "verlet",
            Self::Rk4 => "rk4",
        }
    }
}
