//! Sections of a mesh square to its axis, triangle by triangle.

use super::mesh::TriMesh;
use crate::math::V3;

/// The section of one triangle with the plane through a point square to y, seen from that point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LevelNearest {
    /// squared distance of the point in the plane, m^2
    pub(crate) distance_sq: f64,
    /// from the nearest point of the section to the point, m; square to y
    pub(crate) away: V3,
}

impl TriMesh {
    /// The nearest point of a triangle at the level of `p`, core frame, m; none where it lies wholly above or below.
    pub(crate) fn closest_at_level(&self, triangle: u32, p: V3) -> Option<LevelNearest> {
        let ends = self.section_of(triangle, p.y)?;
        let level = |v: V3| V3::new(v.x, 0.0, v.z);
        let (start, along, from) = (level(ends[0]), level(ends[1] - ends[0]), level(p - ends[0]));
        let length_sq = along.norm_squared();
        let share = if length_sq > 0.0 {
            (from.dot(&along) / length_sq).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let away = level(p) - start - along * share;
        Some(LevelNearest {
            distance_sq: away.norm_squared(),
            away,
        })
    }

    /// Both ends of the section of a triangle at `y`, m; none where it lies wholly above or below.
    fn section_of(&self, triangle: u32, y: f64) -> Option<[V3; 2]> {
        let corner = self.triangles[triangle as usize].map(|v| self.vertices[v as usize]);
        let mut ends = [V3::zeros(); 2];
        let mut found = 0;
        for k in 0..3 {
            let (a, b) = (corner[k], corner[(k + 1) % 3]);
            // A corner right at the level counts as above it, so that every triangle has two ends or none.
            if (a.y < y) != (b.y < y) {
                ends[found] = a + (b - a) * ((y - a.y) / (b.y - a.y));
                found += 1;
            }
        }
        (found == 2).then_some(ends)
    }

    /// Corners of the section of the mesh at `y`, m, each as often as triangles meet there.
    pub(crate) fn section_points(&self, y: f64) -> Vec<V3> {
        let all = 0..self.len() as u32;
        all.filter_map(|t| self.section_of(t, y))
            .flatten()
            .collect()
    }

    /// By asking every triangle, the nearest at the level of `p`: the slow twin of the search.
    #[cfg(test)]
    pub(crate) fn nearest_at_level_brute(&self, p: V3) -> Option<(LevelNearest, u32)> {
        let all = 0..self.len() as u32;
        let found = all.filter_map(|t| Some((self.closest_at_level(t, p)?, t)));
        found.min_by(|a, b| {
            a.0.distance_sq
                .total_cmp(&b.0.distance_sq)
                .then(a.1.cmp(&b.1))
        })
    }
}
