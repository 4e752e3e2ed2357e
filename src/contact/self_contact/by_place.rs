//! Older live wire near a place, wherever along the wire it is.

use crate::math::V3;

/// Nodes in a block. Chosen: a block spans a few wire diameters.
const BLOCK: usize = 16;

/// Live wire in blocks of successive nodes, each in a box.
#[derive(Clone, Debug, Default)]
pub(super) struct Blocks {
    /// lowest and highest coordinates of each block, m
    boxes: Vec<[V3; 2]>,
    /// half the longest edge, m: no place of the wire is farther from its nearest node
    half_edge: f64,
}

impl Blocks {
    /// Puts the wire with nodes at `q`, m, into boxes.
    pub(super) fn build(&mut self, q: &[V3]) {
        self.boxes.clear();
        self.boxes.extend(q.chunks(BLOCK).map(|nodes| {
            let grow = |[low, high]: [V3; 2], p: &V3| [low.inf(p), high.sup(p)];
            nodes.iter().fold([nodes[0]; 2], grow)
        }));
        let longest = q.windows(2).map(|edge| (edge[1] - edge[0]).norm());
        self.half_edge = 0.5 * longest.fold(0.0, f64::max);
    }

    /// Lists in `found` the nodes before `end` at which the wire passes `p`, m, most closely, each in its passage, with wire within `reach`
    /// of it. `q` as at [`Self::build`]; wire goes on after `end`.
    pub(super) fn passages(&self, q: &[V3], p: V3, end: usize, reach: f64, found: &mut Vec<u32>) {
        found.clear();
        let most = (reach + self.half_edge).powi(2);
        let off = |j: usize| (q[j] - p).norm_squared();
        for (block, [low, high]) in self.boxes.iter().enumerate() {
            let first = block * BLOCK;
            if first >= end {
                break;
            }
            if (p - p.sup(low).inf(high)).norm_squared() > most {
                continue;
            }
            for j in first..(first + BLOCK).min(end) {
                let here = off(j);
                if here <= most && here < off(j + 1) && (j == 0 || here <= off(j - 1)) {
                    found.push(j as u32);
                }
            }
        }
    }

    /// Empties the work arrays.
    pub(super) fn clear(&mut self) {
        self.boxes.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wire with loops: every passage within reach, and no other.
    #[test]
    fn blocks_find_what_a_look_at_everything_finds() {
        let q: Vec<V3> = (0..300)
            .map(|k| {
                let s = 0.21 * f64::from(k);
                V3::new((0.9 * s).sin(), 0.02 * s, (1.3 * s).cos() + 0.1 * s)
            })
            .collect();
        let mut blocks = Blocks::default();
        blocks.build(&q);
        let (mut found, mut several) = (Vec::new(), 0);
        for i in 20..300 {
            let (p, end) = (q[i], i - 10);
            blocks.passages(&q, p, end, 0.3, &mut found);
            let off = |j: usize| (q[j] - p).norm();
            let is_passage = |j: &usize| {
                let j = *j;
                off(j) < off(j + 1)
                    && (j == 0 || off(j) <= off(j - 1))
                    && off(j) <= 0.3 + blocks.half_edge
            };
            let all: Vec<u32> = (0..end).filter(is_passage).map(|j| j as u32).collect();
            assert_eq!(found, all);
            several += usize::from(found.len() > 1);
        }
        assert!(several > 20, "{several} places with several passages");
    }
}
