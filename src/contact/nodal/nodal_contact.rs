//! Contact of nodes with the core's mesh and with prisms of frozen wire.

use super::model::NodalModel;
use super::node::{ANCHORS, Anchor, NO_ANCHOR};
use super::state::NodalState;
use crate::contact::own_wire::own_wire;
use crate::geometry::{Surface, Touch, Tube};
use crate::math::V3;

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

/// Work arrays of contact at the nodes. Nothing in here outlives an evaluation.
#[derive(Clone, Debug, Default)]
pub struct NodalScratch {
    /// room for the touches of a node
    touches: Vec<Touch>,
    /// forces of live wire on live wire, one a node, core frame, N
    pub force: Vec<V3>,
}

/// Contact of the explicit methods: the surfaces that the wire can touch, the law, and the state of each live node.
#[derive(Debug)]
pub struct NodalContact<'a> {
    /// core, law and wire
    pub model: &'a NodalModel,
    /// what it remembers
    pub state: &'a mut NodalState,
    /// frozen wire
    pub frozen: &'a Tube,
    /// what it works with
    pub scratch: &'a mut NodalScratch,
}

impl NodalContact<'_> {
    /// Lists the triangles and the frozen wire near node `i`.
    fn look_up(&mut self, i: usize, body: &Body) {
        let skin = self.model.skin();
        let own = own_wire(body.arc, self.model.diameter);
        let (surface, tube) = (&self.model.surface, self.frozen);
        let node = &mut self.state.nodes[i];
        node.centre = body.position;
        let (min, max) = surface.bounds();
        let outside = (min - body.position)
            .sup(&(body.position - max))
            .sup(&V3::zeros())
            .norm();
        let far = 20.0 * skin;
        let core = if outside > far + self.model.radius {
            outside
        } else {
            surface.nearest(body.position).distance
        };
        let room = core.min(tube.clearance(body.position, own)) - self.model.radius;
        if room > skin {
            node.reach = room;
            node.faces.clear();
            node.segments.clear();
            return;
        }
        node.reach = skin;
        surface.near(body.position, self.model.radius + skin, &mut node.faces);
        tube.near(
            body.position,
            self.model.radius + skin,
            own,
            &mut node.segments,
        );
    }

    /// Contact force on live node `i`, core frame, N. With `commit = Some(dt)` anchors move on and the totals of
    /// losses grow by those of the step `dt` (s).
    pub fn force(&mut self, i: usize, body: &Body, commit: Option<f64>) -> V3 {
        let node = &self.state.nodes[i];
        if (body.position - node.centre).norm_squared() >= node.reach * node.reach
            || node.reach < 0.0
        {
            self.look_up(i, body);
        }
        let node = &self.state.nodes[i];
        if node.faces.is_empty() && node.segments.is_empty() {
            if node.count > 0 && commit.is_some() {
                (self.state).release(self.model, i, body.length, &[false; ANCHORS]);
            }
            return V3::zeros();
        }
        let mut touches = std::mem::take(&mut self.scratch.touches);
        touches.clear();
        if !node.faces.is_empty() {
            self.model.surface.touching(
                body.position,
                self.model.radius,
                &node.faces,
                &mut touches,
            );
        }
        let on_core = touches.len();
        if !node.segments.is_empty() {
            self.frozen.touching(
                body.position,
                self.model.radius,
                &node.segments,
                &mut touches,
            );
        }
        let mut total = V3::zeros();
        let mut next = [NO_ANCHOR; ANCHORS];
        let mut kept = [false; ANCHORS];
        let count = touches.len().min(ANCHORS);
        for (k, touch) in touches.iter().take(ANCHORS).enumerate() {
            let on_tube = k >= on_core;
            let old = self.state.nodes[i].match_anchor(on_tube, &touch.normal, &kept);
            let anchor = match old {
                Some(a) => {
                    kept[a] = true;
                    self.state.nodes[i].anchors[a].point
                }
                None => body.position,
            };
            let f = self.model.law.force(
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
                self.state.loss.friction += f.friction.dot(&f.slip).abs();
                self.state.loss.damping += f.damping * dt;
            }
        }
        self.scratch.touches = touches;
        if commit.is_some() {
            (self.state).release(self.model, i, body.length, &kept);
            self.state.nodes[i].anchors = next;
            self.state.nodes[i].count = count;
        }
        total
    }
}

/// A distance from the origin far outside of what wire of this radius can lie on, m.
pub(crate) fn far(core: &Surface, radius: f64) -> f64 {
    let (min, max) = core.bounds();
    10.0 * (max.amax() + min.amax() + radius)
}
