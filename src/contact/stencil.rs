//! The points of line contact: one at each inner node, on the wire's spline, and one at the middle of each edge.
//!
//! Point `2 i` is that of node `i`, point `2 j + 1` that of edge `j`.

use crate::math::V3;
use crate::rod::Rod;

/// Length of wire that a contact point stands for, m.
pub(crate) fn point_length(rod: &Rod, point: usize) -> f64 {
    0.5 * if point.is_multiple_of(2) {
        rod.voronoi(point / 2)
    } else {
        rod.rest[point / 2]
    }
}

/// Point of the wire's spline at node `i` (not an end), m.
pub(crate) fn spline_point(q: &[V3], i: usize) -> V3 {
    (q[i - 1] + q[i + 1]) * 0.125 + q[i] * 0.75
}
