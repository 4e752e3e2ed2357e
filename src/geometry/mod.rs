//! Shapes that wire can touch: the core, and frozen wire on it, in the core's own (turning) frame.
//!
//! The frame: the axis is +y through the origin, the section lies in x-z. Lengths in metres.
//!
//! * [`TriMesh`]: a closed, outward triangle mesh with what every query needs, worked out once
//! * [`generate`]: meshes of the rounded box and the cylinder, and flanges beside any mesh
//! * [`stl`]: meshes from STL files
//! * [`Bvh`]: the search for triangles near a point
//! * [`Touch`]: where a sphere touches the mesh (paper eq. 3-7, mended)
//! * [`Surface`]: mesh and search in one
//!
//! * [`Tube`]: frozen wire as cylinder meshes, for the explicit steps
//! * [`SplineTube`]: frozen wire as a tube with a continuous normal, for smooth contact
//!
//! Nothing here knows the wire: a node is a point with a radius.

pub mod generate;
pub mod stl;
mod stl_text;

mod bodies;
mod bvh;
mod crossing;
mod distance_grid;
mod elements;
mod error;
mod feature;
mod flange;
mod flank;
mod flat;
mod front;
mod grid;
mod hull;
mod level;
mod mesh;
mod room;
mod rounded_rod;
mod shape;
mod spline;
mod surface;
mod topology;
mod touch;
mod tube;
mod wall;

#[cfg(feature = "lab")]
pub use bvh::Bvh;
pub(crate) use crossing::Crossing;
#[cfg(feature = "lab")]
pub use error::MeshError;
pub(crate) use error::Place;
#[cfg(feature = "lab")]
pub use feature::Nearest;
pub use flange::Flanges;
pub(crate) use flank::FLANGE_FACE;
pub(crate) use hull::Hull;
pub use mesh::TriMesh;
pub use room::Room;
pub use rounded_rod::RoundedRod;
pub use shape::{Nearness, Shape};
#[cfg(feature = "lab")]
pub use spline::Foot;
pub use spline::{Curve, SplineTube};
pub use surface::Surface;
pub use touch::Touch;
#[cfg(feature = "lab")]
pub use tube::SIDES;
pub use tube::{FrozenNode, Tube};
pub use wall::WallFoot;
