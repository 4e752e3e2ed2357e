//! How the ends of the wire are held and how the core turns.

use crate::math::{Quat, V3};
use serde::{Deserialize, Serialize};

/// How an end of the wire is held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Support {
    /// which coordinates of the end node are held (all three where the support turns)
    pub hold: [bool; 3],
    /// the place it is held at, m; core frame where `turning`, else lab frame
    pub point: V3,
    /// its velocity in that frame, m/s
    pub velocity: V3,
    /// the direction (and roll) it holds, as a frame with z along the wire; `None`: free to turn
    pub frame: Option<Quat>,
    /// fixed to the core
    pub turning: bool,
}

impl Support {
    /// Not held at all.
    pub fn free() -> Self {
        Self {
            hold: [false; 3],
            point: V3::zeros(),
            velocity: V3::zeros(),
            frame: None,
            turning: false,
        }
    }

    /// Position held, direction free.
    pub fn pinned(point: V3) -> Self {
        Self {
            hold: [true; 3],
            point,
            ..Self::free()
        }
    }

    /// Position and direction held.
    #[cfg(feature = "lab")]
    pub fn clamped(point: V3, frame: Quat) -> Self {
        Self {
            hold: [true; 3],
            point,
            frame: Some(frame),
            ..Self::free()
        }
    }

    pub(crate) fn holds_all(&self) -> bool {
        self.hold == [true; 3]
    }
}

/// The core's motion at this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spindle {
    /// angle, rad
    pub angle: f64,
    /// speed, rad/s
    pub speed: f64,
    /// acceleration, rad/s^2
    pub acceleration: f64,
}

impl Spindle {
    /// The same motion `dt` earlier.
    pub fn before(&self, dt: f64) -> Self {
        self.after(-dt)
    }

    /// The same motion `dt` later.
    pub fn after(&self, dt: f64) -> Self {
        Self {
            angle: self.angle + dt * (self.speed + 0.5 * dt * self.acceleration),
            speed: self.speed + dt * self.acceleration,
            acceleration: self.acceleration,
        }
    }
}
