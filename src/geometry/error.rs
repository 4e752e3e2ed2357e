//! What can be wrong with a mesh, and where.

use crate::math::V3;
use std::fmt;

/// A place on a mesh, m. It reads in millimetres, as programs that draw bodies show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place(pub V3);

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = [self.0.x, self.0.y, self.0.z].map(|m| 1e3 * m);
        write!(f, "x = {x:.3}, y = {y:.3}, z = {z:.3} mm")
    }
}

/// Why vertices and triangles make no surface to wind on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no triangle.
    #[error("the mesh has no triangles")]
    Empty,
    /// Indices are 32 bit.
    #[error("the mesh has {count} {what}, more than the {limit} that can be numbered")]
    TooMany {
        /// vertices or triangles
        what: &'static str,
        /// how many
        count: usize,
        /// how many are allowed
        limit: usize,
    },
    /// A coordinate is NaN, infinite or absurd.
    #[error("vertex {vertex} at ({x}, {y}, {z}) m is not finite or farther than {limit} m out")]
    Coordinate {
        /// vertex index
        vertex: usize,
        /// position, m
        x: f64,
        /// position, m
        y: f64,
        /// position, m
        z: f64,
        /// largest coordinate, m
        limit: f64,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} uses vertex {vertex}, but there are only {count}")]
    NoSuchVertex {
        /// triangle index
        triangle: usize,
        /// vertex index
        vertex: u32,
        /// number of vertices
        count: usize,
    },
    /// A triangle has no area.
    #[error(
        "the triangle with a side at {at} has no area (triangle {triangle}, height {height:.3e} m on a side of {longest:.3e} m); mesh the body once more, or merge the corners there"
    )]
    Degenerate {
        /// middle of the longest side
        at: Place,
        /// triangle index
        triangle: usize,
        /// least height, m
        height: f64,
        /// longest side, m
        longest: f64,
    },
    /// An edge has a triangle on one side only.
    #[error("the mesh is open: the edge at {at} has only triangle {triangle}")]
    Open {
        /// middle of the edge
        at: Place,
        /// the only triangle
        triangle: u32,
    },
    /// An edge has more than two triangles.
    #[error(
        "the mesh is not a surface: the edge at {at} has {count} triangles, triangle {triangle} among them; unite bodies that touch there, or move them apart"
    )]
    NonManifold {
        /// middle of the edge
        at: Place,
        /// how many triangles
        count: usize,
        /// the first of them
        triangle: u32,
    },
    /// Two neighbours disagree about which side is out.
    #[error(
        "triangles {first} and {second} run along the edge at {at} in the same direction: one is turned over"
    )]
    Twisted {
        /// middle of the edge
        at: Place,
        /// triangle index
        first: u32,
        /// triangle index
        second: u32,
    },
    /// Two neighbours lie back to back.
    #[error("triangles {first} and {second} are folded flat onto each other at the edge at {at}")]
    Folded {
        /// middle of the edge
        at: Place,
        /// triangle index
        first: u32,
        /// triangle index
        second: u32,
    },
    /// Normals point inwards.
    #[error("the mesh is inside out: its signed volume is {volume:.3e} m^3, not positive")]
    InsideOut {
        /// signed volume, m^3
        volume: f64,
    },
    /// Normals of one of several bodies point inwards, and it is no cavity in the others.
    #[error(
        "the body with a corner at {at} is inside out: its signed volume is {volume:.3e} m^3, not positive, and it is no cavity in another body"
    )]
    BodyInsideOut {
        /// one of its corners that lies in no other body
        at: Place,
        /// its signed volume, m^3
        volume: f64,
    },
    /// A dimension of a generated shape is out of range.
    #[error("{name} = {value} is out of range: {allowed}")]
    Dimension {
        /// which one
        name: &'static str,
        /// what was given
        value: f64,
        /// what is allowed
        allowed: String,
    },
}
