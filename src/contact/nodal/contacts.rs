//! Contact of nodes with the core's mesh and with prisms of frozen wire.

use super::node::{ANCHORS, Anchor, NO_ANCHOR, NodeContact};
use crate::contact::law::{ContactLaw, ContactLoss};
use crate::contact::own_wire::own_wire;
use crate::geometry::{FrozenNode, Surface, Touch, Tube};
use crate::math::V3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Distance beyond touching within which surfaces are listed, in wire diameters. Chosen: a handful of triangles lies within,
/// and the list lasts some steps.
const SKIN: f64 = 0.1;

/// Motion, length and mass of a node, core frame.
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

/// The part of [`Contacts`] that the scene does not give.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedContacts {
    nodes: Vec<NodeContact>,
    loss: ContactLoss,
    frozen: Vec<FrozenNode>,
}

/// Contact of the explicit methods: the surfaces that the wire can touch, the law, and the state of each live node.
#[derive(Clone, Debug)]
pub struct Contacts {
    /// the core's mesh
    pub surface: Arc<Surface>,
    /// frozen wire
    pub tube: Tube,
    /// the law
    pub law: ContactLaw,
    /// wire radius, m (0: the centreline itself touches)
    pub radius: f64,
    /// per live node
    pub nodes: Vec<NodeContact>,
    /// totals of what was dissipated
    pub loss: ContactLoss,
    /// room for the touches of a node
    touches: Vec<Touch>,
    /// way beyond touching that a search covers, m
    skin: f64,
}

impl Contacts {
    /// Contact of `nodes` nodes, none of them in touch, without frozen wire. `radius` is that with which the wire touches,
    /// `diameter` that of the wire, m.
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
            skin: SKIN * diameter,
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

    /// Takes over the saved state of a wire with so many live nodes; an error says what is impossible about it.
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

    /// Makes every node look its surroundings up again; call when frozen wire has changed.
    pub fn forget_surroundings(&mut self) {
        for n in &mut self.nodes {
            n.reach = -1.0;
        }
    }

    /// Lists the triangles and the frozen wire near node `i`.
    fn look_up(&mut self, i: usize, body: &Body) {
        let own = own_wire(body.arc, 2.0 * self.wire_radius());
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

    /// Radius of the wire, m, also where its centreline touches the core.
    fn wire_radius(&self) -> f64 {
        self.skin / (2.0 * SKIN)
    }

    /// Contact force on live node `i`, core frame, N. With `commit = Some(dt)` anchors move on and the totals of
    /// losses grow by those of the step `dt` (s).
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
            let old = self.nodes[i].match_anchor(on_tube, &touch.normal, &kept);
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

    /// Ends all touches of node `i`; the bristles of those not `kept` lose what they stored.
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
