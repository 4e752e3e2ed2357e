//! The core the wire is wound on, as geometry in its own (turning) frame.
//!
//! The frame: the axis is +y through the origin, the section lies in x-z. Lengths in metres.
//!
//! * [`TriMesh`]: a closed, outward triangle mesh with what every query needs, worked out once
//! * [`generate`]: meshes of the rounded box and the cylinder
//! * [`stl`]: meshes from STL files
//! * [`Bvh`]: the search for triangles near a point
//! * [`Touch`]: where a sphere touches the mesh (paper eq. 3-7, mended)
//! * [`Surface`]: mesh and search in one
//!
//! Nothing here knows the wire: a node is a point with a radius.

pub mod generate;
pub mod stl;

mod bvh;
mod error;
mod feature;
mod mesh;
mod shape;
mod surface;
mod topology;
mod touch;

pub use bvh::Bvh;
pub use error::MeshError;
pub use feature::Nearest;
pub use mesh::TriMesh;
pub use shape::{Nearness, Shape};
pub use surface::Surface;
pub use touch::Touch;
