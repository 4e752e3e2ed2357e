//! Distances of a surface on a grid: bounds that spare most searches, and a triangle to begin the others at.
//!
//! A point's distance differs from that of the middle of its cell by no more than the way between them. Where wire is wound
//! between high flanges, most of it is inside the box of the mesh and far from every triangle, and that says so.

use super::bvh::Bvh;
use super::mesh::TriMesh;
use crate::math::V3;

/// Cells at most. Chosen: they take some 10 ms to fill, and a coil between high flanges no fewer steps with four times as many.
const CELLS: usize = 1 << 12;

/// What is known of one cell.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// signed distance of its middle, m
    distance: f64,
    /// the triangle nearest to its middle
    triangle: u32,
}

/// A grid of cubes that fills the bounding box of a mesh, core frame.
#[derive(Clone, Debug)]
pub(super) struct DistanceGrid {
    low: V3,
    /// side of a cube, m
    side: f64,
    /// cubes along each axis
    count: [usize; 3],
    cells: Vec<Cell>,
    /// rounding of a distance, m
    hair: f64,
}

/// What a grid says of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// signed distance at least, m
    pub(super) least: f64,
    /// signed distance at most, m
    pub(super) most: f64,
    /// a triangle that may be the nearest
    pub(super) triangle: u32,
}

impl DistanceGrid {
    /// The grid of a mesh with its search tree and bounding box.
    pub(super) fn new(mesh: &TriMesh, tree: &Bvh, (low, high): (V3, V3)) -> Self {
        let extent = high - low;
        let count_of = |side: f64| {
            let along = |axis: usize| (extent[axis] / side).ceil().max(1.0);
            [along(0), along(1), along(2)]
        };
        let mut side = libm::cbrt(extent.product() / CELLS as f64);
        while count_of(side).iter().product::<f64>() > CELLS as f64 {
            side *= 1.05;
        }
        let mut grid = Self {
            low,
            side,
            count: count_of(side).map(|n| n as usize),
            cells: Vec::new(),
            hair: mesh.tiny,
        };
        let mut triangle = u32::MAX;
        for number in 0..grid.count.iter().product() {
            let (nearest, found) = tree.nearest_from(mesh, grid.middle(number), triangle);
            triangle = found;
            grid.cells.push(Cell {
                distance: nearest.distance,
                triangle,
            });
        }
        grid
    }

    /// Middle of a cell, m.
    fn middle(&self, number: usize) -> V3 {
        let [nx, ny, _] = self.count;
        let index = [number % nx, number / nx % ny, number / (nx * ny)];
        self.low + V3::from_fn(|axis, _| (index[axis] as f64 + 0.5) * self.side)
    }

    /// What is known of `p`, m, inside the box or not.
    #[inline]
    pub(super) fn bounds(&self, p: V3) -> Bounds {
        let offset = (p - self.low) / self.side;
        // (the conversion takes what is below 0 to 0)
        let index = |axis: usize| (offset[axis] as usize).min(self.count[axis] - 1);
        let [x, y, z] = [index(0), index(1), index(2)];
        let cell = self.cells[(z * self.count[1] + y) * self.count[0] + x];
        let middle = V3::new(x as f64 + 0.5, y as f64 + 0.5, z as f64 + 0.5);
        let way = (offset - middle).norm() * self.side + self.hair;
        Bounds {
            least: cell.distance - way,
            most: cell.distance + way,
            triangle: cell.triangle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::super::surface::Surface;
    use super::CELLS;
    use crate::math::V3;
    use proptest::prelude::*;

    fn spool() -> Surface {
        let mesh = generate::grooved_pulley(10e-3, 1.0, 2e-3, 64).expect("a pulley");
        Surface::new(mesh)
    }

    proptest! {
        #[test]
        fn bounds_hold_the_distance(x in -15.0..15.0, y in -4.0..4.0, z in -15.0..15.0) {
            let surface = spool();
            let p = V3::new(x, y, z) * 1e-3;
            let bounds = surface.grid().bounds(p);
            let exact = surface.mesh().nearest_brute(p).distance;
            prop_assert!(bounds.least <= exact && exact <= bounds.most, "{bounds:?}, {exact}");
            prop_assert!((bounds.triangle as usize) < surface.mesh().len());
        }
    }

    /// Cubes in proportion to the volume of its box would be a million times as many.
    #[test]
    fn a_thin_plate_has_a_grid() {
        let plate = generate::rounded_box(0.5, 1.0, 1e-6, 0.0, 1);
        let surface = Surface::new(plate.expect("a plate"));
        assert!(surface.grid().cells.len() <= CELLS);
        let p = V3::new(0.1, 0.0, 0.2);
        let (bounds, exact) = (surface.grid().bounds(p), surface.nearest(p).distance);
        assert!(bounds.least <= exact && exact <= bounds.most, "{bounds:?}");
    }
}
