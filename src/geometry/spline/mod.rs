//! Frozen wire as a smooth tube: its centreline is a quadratic B-spline, C1 along the wire.
//!
//! The prisms of [`super::Tube`] have facets and mitres, on which an implicit step would rattle.
//! Here the surface is all that is one radius away from a curve with a continuous tangent. So the
//! distance of a point from it is C1 as long as the point is nearer than the centre of curvature.
//!
//! # The curve
//!
//! Node k with its neighbours gives segment k, from the middle of edge k-1 to the middle of edge k,
//! tangent to both there:
//!
//! ```text
//! C(s) = (1-s)^2/2 P[k-1] + (1/2 + s - s^2) P[k] + s^2/2 P[k+1],   0 <= s <= 1
//! ```
//!
//! It cuts corners: at node k it passes `(P[k-1] - 2 P[k] + P[k+1])/8` inside. Both ends have a
//! neighbour mirrored in them, `2 P[0] - P[1]`. Their segments are straight and have half of
//! the range of s. The wire starts at node 0 with s = 1/2 in segment 0 and ends at node n-1 with
//! s = 1/2 in segment n-1. There are as many segments as nodes, and C' is continuous throughout.
//!
//! # Seams
//!
//! A seam is where frozen wire goes on as live wire. Both curves hold the edge about the seam, so
//! both pass the middle of that edge in its direction; there one curve ends and the other begins. A
//! point whose nearest point lies past the seam has its foot at the end of this curve, with
//! [`Foot::beyond`] above zero, and does not touch it. A wire that simply ended here would be a
//! chord where it lies bent, off by an eighth of the second difference of its nodes.
//!
//! # The foot of a point p
//!
//! Half the derivative of the squared distance, g(s) = (C - p) C', is a cubic on a segment. Where
//! it goes from falling (g < 0) to rising there is a local minimum. At a joint g is the same number
//! to the bit from either side, so that a minimum belongs to one segment and to one only.

mod curve;
mod segment;
#[cfg(test)]
mod tests;
mod tube;

pub use curve::Curve;
#[cfg(any(test, feature = "lab"))]
pub use segment::Foot;
pub use tube::SplineTube;
