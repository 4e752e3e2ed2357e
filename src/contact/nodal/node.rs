//! Contact state of one node of the explicit methods.

use crate::math::V3;
use serde::{Deserialize, Serialize};

/// Anchors that a node can hold at once: core face and flange, and two turns of a groove, with room.
pub(super) const ANCHORS: usize = 6;

/// Cosine between normals above which two touches are the same touch at successive steps. Chosen.
const SAME_TOUCH: f64 = 0.7;

/// Friction anchor of one touch, core frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Anchor {
    /// on frozen wire, not on the core
    pub(super) on_tube: bool,
    /// unit normal of the touch
    pub(super) normal: V3,
    /// the anchor, m
    pub(super) point: V3,
    /// stretch of the bristle from there, m
    pub(super) bristle: V3,
    /// depth of the touch, m
    pub(super) depth: f64,
}

/// An unused anchor.
pub(super) const NO_ANCHOR: Anchor = Anchor {
    on_tube: false,
    normal: V3::new(0.0, 0.0, 0.0),
    point: V3::new(0.0, 0.0, 0.0),
    bristle: V3::new(0.0, 0.0, 0.0),
    depth: 0.0,
};

/// Contact state of a node: its friction anchors, and the surfaces near it.
///
/// The node looks its surroundings up again once it has moved by `reach` from `centre`, so that a node of the free
/// span costs one comparison a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "SavedNode", into = "SavedNode")]
pub struct NodeContact {
    /// the first `count` are in use
    pub(super) anchors: [Anchor; ANCHORS],
    pub(super) count: usize,
    /// where the surroundings were looked up, m, and how far that holds, m; negative: not at all
    pub(super) centre: V3,
    pub(super) reach: f64,
    /// triangles of the core and segments of frozen wire near there
    pub(super) faces: Vec<u32>,
    pub(super) segments: Vec<u32>,
}

impl NodeContact {
    /// A node without anchors whose surroundings are unknown.
    pub fn new() -> Self {
        Self {
            anchors: [NO_ANCHOR; ANCHORS],
            count: 0,
            centre: V3::zeros(),
            reach: -1.0,
            faces: Vec::new(),
            segments: Vec::new(),
        }
    }

    /// The anchor of a touch with this normal, among those not yet taken.
    pub(super) fn match_anchor(
        &self,
        on_tube: bool,
        normal: &V3,
        taken: &[bool; ANCHORS],
    ) -> Option<usize> {
        let mut best = None;
        let mut agree = SAME_TOUCH;
        for a in 0..self.count {
            let anchor = &self.anchors[a];
            let dot = anchor.normal.dot(normal);
            if anchor.on_tube == on_tube && !taken[a] && dot > agree {
                agree = dot;
                best = Some(a);
            }
        }
        best
    }

    /// Whether the node touched anything at the last committed evaluation.
    pub fn touches(&self) -> bool {
        self.count > 0
    }

    /// Deepest penetration at the last committed evaluation, m.
    pub fn depth(&self) -> f64 {
        self.anchors[..self.count]
            .iter()
            .map(|a| a.depth)
            .fold(0.0, f64::max)
    }
}

impl Default for NodeContact {
    fn default() -> Self {
        Self::new()
    }
}

/// A [`NodeContact`] in a saved state. The surroundings belong to it: the order of the faces decides the
/// rounding of a sum.
#[derive(Serialize, Deserialize)]
struct SavedNode {
    anchors: Vec<Anchor>,
    centre: V3,
    reach: f64,
    faces: Vec<u32>,
    segments: Vec<u32>,
}

impl From<NodeContact> for SavedNode {
    fn from(node: NodeContact) -> Self {
        Self {
            anchors: node.anchors[..node.count].to_vec(),
            centre: node.centre,
            reach: node.reach,
            faces: node.faces,
            segments: node.segments,
        }
    }
}

impl TryFrom<SavedNode> for NodeContact {
    type Error = &'static str;

    fn try_from(saved: SavedNode) -> Result<Self, &'static str> {
        let mut node = Self::new();
        node.count = saved.anchors.len();
        let held = node.anchors.get_mut(..node.count);
        held.ok_or("a node has too many anchors")?
            .copy_from_slice(&saved.anchors);
        (node.centre, node.reach) = (saved.centre, saved.reach);
        (node.faces, node.segments) = (saved.faces, saved.segments);
        Ok(node)
    }
}
