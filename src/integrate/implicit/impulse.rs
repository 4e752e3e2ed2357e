//! The impulse of one touch on the nodes that it moves with.

use crate::contact::AcceptedTouch;
use crate::math::V3;

/// The velocities now, those at the step's start, and the places there.
pub(super) const PARTS: usize = 3;

/// The impulse of one touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impulse {
    pub(super) touch: AcceptedTouch,
    /// nodes that it moves, and their weights; those of an older live wire have negative ones
    pub(super) nodes: [usize; 6],
    pub(super) weights: [f64; 6],
    /// change of the nodes' speeds by an impulse there, 1/kg
    shares: [f64; 6],
    /// how many they are
    pub(super) count: usize,
    /// direction, whose part along the normal is 1
    pub(super) along: V3,
    /// what the solve gave along the normal, N s
    pub(super) given: f64,
    /// change of speed along the normal by an impulse there, 1/kg
    pub(super) inverse: f64,
    /// least and largest speed, m/s, or place, m, along the normal
    pub(super) range: [[f64; 2]; PARTS],
    /// the impulse added, N s, and N s^2 for the places
    pub(super) added: [f64; PARTS],
}

impl Impulse {
    /// None yet, of a touch of the wire at `places` (m) in a step that ends with forces acting over `gamma` (s); `None` where
    /// nothing pushes or can move.
    ///
    /// What pulls along the wire is left to the solve: an edge is so stiff that it moves with all wire that a wave reaches in the step.
    pub(super) fn of(
        touch: &AcceptedTouch,
        gamma: f64,
        mobility: &[f64],
        places: &[V3],
    ) -> Option<Self> {
        let pressed = touch.force.dot(&touch.normal);
        let (mut nodes, mut weights, mut shares) = ([0; 6], [0.0; 6], [0.0; 6]);
        let mut count = 0;
        for place in [Some(touch.point.weights()), touch.old]
            .into_iter()
            .flatten()
        {
            for (i, w) in place.iter().filter(|(_, w)| *w != 0.0) {
                (nodes[count], weights[count], shares[count]) = (i, w, w * mobility[i]);
                count += 1;
            }
        }
        let mobile = |(i, w): (usize, f64)| w * w * mobility[i];
        let parts = nodes.into_iter().zip(weights).take(count);
        let inverse: f64 = parts.map(mobile).sum();
        let young = touch.point.weights().nodes;
        let tangent = (places[young[2]] - places[young[0]]).normalize();
        let of_wire = |v: V3| v - tangent * v.dot(&tangent);
        let touch = AcceptedTouch {
            surplus: of_wire(touch.surplus),
            ..*touch
        };
        let friction = touch.force - touch.normal * pressed;
        (pressed > 0.0 && inverse > 0.0).then(|| Self {
            touch,
            nodes,
            weights,
            shares,
            count,
            along: touch.normal + of_wire(friction) / pressed,
            given: gamma * pressed,
            inverse,
            range: [[0.0; 2]; PARTS],
            added: [0.0; PARTS],
        })
    }

    /// Nodes that the touch moves with, and their weights.
    #[inline]
    pub(super) fn nodes(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.weights[..self.count].iter().copied())
    }

    /// The same, with the change of each node's speed by an impulse there, 1/kg.
    #[inline]
    pub(super) fn shares(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.shares[..self.count].iter().copied())
    }

    /// What the touch sees of a motion of the nodes, along its normal.
    #[inline]
    pub(super) fn along_normal(&self, motion: &[V3]) -> f64 {
        let normal = self.touch.normal;
        let part = |(i, w): (usize, f64)| w * motion[i].dot(&normal);
        self.nodes().map(part).sum()
    }
}
