//! A core from a mesh file: a prism or a bobbin.

use super::bobbin::Bobbin;
use super::prism::Prism;
use crate::settings::SceneSettings;

/// What the file holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mesh {
    /// convex
    Prism(Prism),
    /// concave
    Bobbin(Bobbin),
}

impl Mesh {
    /// Largest distance from the axis, m.
    pub fn turning_radius(&self) -> f64 {
        match self {
            Self::Prism(prism) => prism.turning_radius(),
            Self::Bobbin(bobbin) => bobbin.turning_radius(),
        }
    }

    /// Radius of a cylinder as thick as what the wire lies on, m.
    pub fn barrel(&self) -> f64 {
        match self {
            Self::Prism(prism) => prism.turning_radius(),
            Self::Bobbin(bobbin) => bobbin.barrel,
        }
    }

    /// The settings with a box of the same width, so that they can be checked without a file.
    pub fn stand_in(&self, settings: &SceneSettings) -> SceneSettings {
        let mut s = settings.clone();
        let size = 2.0 * self.turning_radius();
        s.core.shape = "rounded-box".to_owned();
        (s.core.width_x, s.core.height_z) = (size, size);
        s.core.corner_radius = 0.5 * size;
        s
    }

    /// An ASCII STL file in mm.
    pub fn stl(&self) -> String {
        match self {
            Self::Prism(prism) => prism.stl(),
            Self::Bobbin(bobbin) => bobbin.stl(),
        }
    }
}
