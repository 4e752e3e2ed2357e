//! Triangles without area, which close T-junctions.
//!
//! A corner within the side of another triangle would leave that side open. Programs that draw bodies write a triangle of three
//! corners on a line there. With its neighbour across its longest side it makes up a quadrilateral, which the other diagonal cuts
//! into two triangles that have an area. The surface stays the same.

use super::mesh::has_area;
use crate::math::V3;
use std::collections::HashMap;

/// Cuts the quadrilaterals of triangles without area and their neighbours the other way, as far as that gives them one.
pub(super) fn cut_the_other_way(vertices: &[V3], triangles: &mut [[u32; 3]]) {
    let flat = |t: &[u32; 3]| !has_area(t.map(|v| vertices[v as usize]));
    let mut left: Vec<usize> = (0..triangles.len())
        .filter(|&t| flat(&triangles[t]))
        .collect();
    if left.is_empty() {
        return;
    }
    let mut sides = HashMap::with_capacity(3 * triangles.len());
    for (index, &triangle) in triangles.iter().enumerate() {
        enter(&mut sides, index, triangle);
    }
    // (a neighbour may have no area itself before it has been cut)
    let mut before = usize::MAX;
    while left.len() < before {
        before = left.len();
        left.retain(|&t| !cut(vertices, triangles, &mut sides, t));
    }
}

/// Triangles by their sides, as they run.
type Sides = HashMap<[u32; 2], usize>;

fn enter(sides: &mut Sides, index: usize, [a, b, c]: [u32; 3]) {
    for side in [[a, b], [b, c], [c, a]] {
        sides.insert(side, index);
    }
}

/// Cuts the quadrilateral of a triangle without area; false where that does not help.
fn cut(vertices: &[V3], triangles: &mut [[u32; 3]], sides: &mut Sides, flat: usize) -> bool {
    let at = |v: u32| vertices[v as usize];
    let [a, b, c] = triangles[flat];
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    let length = |[from, to, _]: &[u32; 3]| (at(*to) - at(*from)).norm();
    let Some([from, to, middle]) = turns
        .into_iter()
        .max_by(|p, q| length(p).total_cmp(&length(q)))
    else {
        return false;
    };
    let Some(&other) = sides.get(&[to, from]) else {
        return false;
    };
    let mut of_other = triangles[other].into_iter();
    let Some(far) = of_other.find(|v| *v != from && *v != to) else {
        return false;
    };
    let halves = [[middle, from, far], [far, to, middle]];
    let known = [[far, middle], [middle, far]];
    if known.iter().any(|side| sides.contains_key(side))
        || !halves
            .iter()
            .all(|half| has_area(half.map(|v| vertices[v as usize])))
    {
        return false;
    }
    sides.remove(&[from, to]);
    sides.remove(&[to, from]);
    for (index, half) in [flat, other].into_iter().zip(halves) {
        triangles[index] = half;
        enter(sides, index, half);
    }
    true
}
