//! Wire against core and against frozen wire: search, touch, friction anchors.
//!
//! Everything here happens in the core frame, in which core and frozen turns are at rest. Each
//! node remembers how far it may move before its surroundings have to be looked up again, so a
//! node in the free span costs one comparison a step.

mod between;
mod law;
mod line;
mod live;
mod point;
mod stencil;
mod touch;

pub use between::{Between, Cross, PairPush, Triple, add_cross, point_weights};
pub use law::{ContactLaw, TouchForce, damping_for_restitution};
pub(crate) use line::SavedLine;
pub use line::{LineContact, own_wire};
pub use live::{LiveContact, Wire};
pub use point::Memory;
pub(crate) use stencil::{point_length, spline_point};
pub use touch::Push;

use crate::geometry::{FrozenNode, Tube};
use crate::geometry::{Surface, Touch};
use crate::math::V3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Anchors a node can hold at once: core face and flange, and two turns of a groove, with room.
const ANCHORS: usize = 6;

/// Wire this many diameters back along itself is no neighbour (it cannot bend that sharply).
const OWN_WIRE: f64 = 5.0;

/// Touches whose normals agree better than this are the same touch at the next step.
const SAME_TOUCH: f64 = 0.7;

/// Friction anchor of one touch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Anchor {
    on_tube: bool,
    normal: V3,
    point: V3,
    bristle: V3,
    depth: f64,
}

const NO_ANCHOR: Anchor = Anchor {
    on_tube: false,
    normal: V3::new(0.0, 0.0, 0.0),
    point: V3::new(0.0, 0.0, 0.0),
    bristle: V3::new(0.0, 0.0, 0.0),
    depth: 0.0,
};

/// What a node knows of its surroundings.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "SavedNode", into = "SavedNode")]
pub struct NodeContact {
    anchors: [Anchor; ANCHORS],
    count: usize,
    // cache, rebuilt at will
    centre: V3,
    reach: f64,
    faces: Vec<u32>,
    segments: Vec<u32>,
}

impl NodeContact {
    /// Knows nothing yet.
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

    /// Whether the node touched anything at the last committed evaluation.
    pub fn touches(&self) -> bool {
        self.count > 0
    }

    /// Whether it touched frozen wire.
    pub fn touches_wire(&self) -> bool {
        self.anchors[..self.count].iter().any(|a| a.on_tube)
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

/// A [`NodeContact`] in a saved state. The surroundings belong to it: in which order faces are met decides
/// the rounding of a sum.
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

/// A node as contact sees it, core frame.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// position, m
    pub position: V3,
    /// velocity relative to the core, m/s
    pub velocity: V3,
    /// wire length it stands for, m
    pub length: f64,
    /// mass, kg
    pub mass: f64,
    /// unstretched length from the clamp, m
    pub arc: f64,
}

/// Running totals of what contact dissipated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactLoss {
    /// slip against friction, J
    pub friction: f64,
    /// contact dashpots, J
    pub damping: f64,
}

/// The part of [`Contacts`] that the scene does not give.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedContacts {
    nodes: Vec<NodeContact>,
    loss: ContactLoss,
    frozen: Vec<FrozenNode>,
}

/// A distance from the origin far outside of what wire of this radius can lie on, m.
pub(crate) fn far(core: &Surface, radius: f64) -> f64 {
    let (min, max) = core.bounds();
    10.0 * (max.amax() + min.amax() + radius)
}

/// Frozen wire of `radius`, m, through saved nodes, none of which is `far`, m, from the origin.
///
/// Fails with what is impossible about the nodes.
pub(crate) fn restore_tube(
    frozen: Vec<FrozenNode>,
    radius: f64,
    far: f64,
) -> Result<Tube, &'static str> {
    let mut tube = Tube::new(radius);
    let mut arc = f64::NEG_INFINITY;
    let mut before = None;
    for node in frozen {
        let near = node.point.iter().all(|x| x.abs() < far);
        let sound = near && node.arc >= arc && before != Some(node.point);
        if !sound {
            return Err("frozen wire is not one");
        }
        (arc, before) = (node.arc, Some(node.point));
        tube.push(node);
    }
    Ok(tube)
}

/// The surfaces the wire can touch and how it touches them.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// the core
    pub surface: Arc<Surface>,
    /// frozen wire
    pub tube: Tube,
    /// the law
    pub law: ContactLaw,
    /// wire radius, m (0: the centreline itself touches)
    pub radius: f64,
    /// per live node
    pub nodes: Vec<NodeContact>,
    /// totals
    pub loss: ContactLoss,
    touches: Vec<Touch>,
    skin: f64,
}

impl Contacts {
    /// No node in contact, no frozen wire.
    pub fn new(
        surface: Arc<Surface>,
        law: ContactLaw,
        radius: f64,
        diameter: f64,
        nodes: usize,
    ) -> Self {
        Self {
            surface,
            tube: Tube::new(0.5 * diameter),
            law,
            radius,
            nodes: vec![NodeContact::new(); nodes],
            loss: ContactLoss::default(),
            touches: Vec::new(),
            // small enough that a handful of triangles lies within, large enough to last some steps
            skin: 0.1 * diameter,
        }
    }

    /// What a saved state has to hold.
    pub(crate) fn saved(&self) -> SavedContacts {
        SavedContacts {
            nodes: self.nodes.clone(),
            loss: self.loss,
            frozen: self.tube.nodes().collect(),
        }
    }

    /// Takes a saved state over, of a wire with so many live nodes. Says what is impossible about it.
    pub(crate) fn restore(
        &mut self,
        saved: SavedContacts,
        nodes: usize,
    ) -> Result<(), &'static str> {
        if saved.nodes.len() != nodes {
            return Err("contacts do not go with the nodes");
        }
        let (faces, segments) = (
            self.surface.mesh().triangles.len(),
            saved.frozen.len().saturating_sub(1),
        );
        for node in &saved.nodes {
            let known = node.reach < 0.0
                || node.faces.iter().all(|f| (*f as usize) < faces)
                    && node.segments.iter().all(|s| (*s as usize) < segments);
            if !known {
                return Err("a node's surroundings are beyond core and frozen wire");
            }
        }
        let tube = restore_tube(
            saved.frozen,
            self.tube.radius(),
            far(&self.surface, self.radius),
        )?;
        (self.nodes, self.loss, self.tube) = (saved.nodes, saved.loss, tube);
        Ok(())
    }

    /// Frozen wire changed: look everything up again.
    pub fn forget_surroundings(&mut self) {
        for n in &mut self.nodes {
            n.reach = -1.0;
        }
    }

    fn look_up(&mut self, i: usize, body: &Body) {
        let own = body.arc - OWN_WIRE * 2.0 * self.tube_radius();
        let (surface, tube) = (&self.surface, &self.tube);
        let node = &mut self.nodes[i];
        node.centre = body.position;
        let (min, max) = surface.bounds();
        let outside = (min - body.position)
            .sup(&(body.position - max))
            .sup(&V3::zeros())
            .norm();
        let far = 20.0 * self.skin;
        let core = if outside > far + self.radius {
            outside
        } else {
            surface.nearest(body.position).distance
        };
        let room = core.min(tube.clearance(body.position, own)) - self.radius;
        if room > self.skin {
            node.reach = room;
            node.faces.clear();
            node.segments.clear();
            return;
        }
        node.reach = self.skin;
        surface.near(body.position, self.radius + self.skin, &mut node.faces);
        tube.near(
            body.position,
            self.radius + self.skin,
            own,
            &mut node.segments,
        );
    }

    fn tube_radius(&self) -> f64 {
        // the tube carries the wire's own radius even where the centreline touches the core
        self.skin / 0.2
    }

    /// Contact force on live node `i`, core frame, N. With `commit = Some(dt)` anchors move on and
    /// the totals grow by what is lost in `dt`.
    pub fn force(&mut self, i: usize, body: &Body, commit: Option<f64>) -> V3 {
        let node = &self.nodes[i];
        if (body.position - node.centre).norm_squared() >= node.reach * node.reach
            || node.reach < 0.0
        {
            self.look_up(i, body);
        }
        let node = &self.nodes[i];
        if node.faces.is_empty() && node.segments.is_empty() {
            if node.count > 0 && commit.is_some() {
                self.release(i, body.length, &[false; ANCHORS]);
            }
            return V3::zeros();
        }
        let mut touches = std::mem::take(&mut self.touches);
        touches.clear();
        if !node.faces.is_empty() {
            self.surface
                .touching(body.position, self.radius, &node.faces, &mut touches);
        }
        let on_core = touches.len();
        if !node.segments.is_empty() {
            self.tube
                .touching(body.position, self.radius, &node.segments, &mut touches);
        }
        let mut total = V3::zeros();
        let mut next = [NO_ANCHOR; ANCHORS];
        let mut kept = [false; ANCHORS];
        let count = touches.len().min(ANCHORS);
        for (k, touch) in touches.iter().take(ANCHORS).enumerate() {
            let on_tube = k >= on_core;
            let old = self.match_anchor(i, on_tube, &touch.normal, &kept);
            let anchor = match old {
                Some(a) => {
                    kept[a] = true;
                    self.nodes[i].anchors[a].point
                }
                None => body.position,
            };
            let f = self.law.force(
                touch.normal,
                touch.depth,
                body.velocity,
                body.position - anchor,
                body.length,
                body.mass,
            );
            total += f.force;
            if let Some(dt) = commit {
                next[k] = Anchor {
                    on_tube,
                    normal: touch.normal,
                    point: body.position - f.bristle,
                    bristle: f.bristle,
                    depth: touch.depth,
                };
                self.loss.friction += f.friction.dot(&f.slip).abs();
                self.loss.damping += f.damping * dt;
            }
        }
        self.touches = touches;
        if commit.is_some() {
            self.release(i, body.length, &kept);
            self.nodes[i].anchors = next;
            self.nodes[i].count = count;
        }
        total
    }

    fn match_anchor(
        &self,
        i: usize,
        on_tube: bool,
        normal: &V3,
        taken: &[bool; ANCHORS],
    ) -> Option<usize> {
        let node = &self.nodes[i];
        let mut best = None;
        let mut agree = SAME_TOUCH;
        for a in 0..node.count {
            let anchor = &node.anchors[a];
            let dot = anchor.normal.dot(normal);
            if anchor.on_tube == on_tube && !taken[a] && dot > agree {
                agree = dot;
                best = Some(a);
            }
        }
        best
    }

    /// Bristles of touches that ended let go of what they stored.
    fn release(&mut self, i: usize, length: f64, kept: &[bool; ANCHORS]) {
        let node = &mut self.nodes[i];
        for a in 0..node.count {
            if !kept[a] {
                self.loss.friction += self.law.stored(0.0, node.anchors[a].bristle, length);
            }
        }
        node.count = 0;
    }

    /// Energy stored in node `i`'s touches at the last committed evaluation, J.
    pub fn stored(&self, i: usize, length: f64) -> f64 {
        let node = &self.nodes[i];
        node.anchors[..node.count]
            .iter()
            .map(|a| self.law.stored(a.depth, a.bristle, length))
            .sum()
    }
}
