//! State of the wire's contact with core and frozen wire, and how it follows changes of the wire.

use super::near::NearPoint;
use super::point::PointState;
use super::record::ContactRecord;
use crate::contact::law::{ContactLaw, ContactLoss};
use crate::contact::self_contact::{Coupling, SelfContact};
use crate::contact::stencil::ContactPoint;
use crate::geometry::{Shape, SplineTube};
use crate::math::V3;

/// Depth over which the normal force sets in, m. Chosen: ten times as much takes a tenth off the evaluations and adds
/// 4.5 um to the depth at rest.
const ONSET: f64 = 1e-6;

/// Contact of the implicit method: the surfaces that the wire can touch, the law, and the state of each contact point.
///
/// Points are numbered as [`ContactPoint`] says; `k` stands for such a number. Places are in the core frame.
#[derive(Clone, Debug)]
pub struct LineContact {
    /// the core
    pub shape: Shape,
    /// frozen wire; it grows by [`Self::lay`]
    pub tube: SplineTube,
    /// the law
    pub law: ContactLaw,
    /// depth over which the normal force sets in, m
    pub onset: f64,
    /// line load per rate of depth, N s/m^2, and as much of it along the surface as of the stiffness. The sum of
    /// spring and dashpot never pulls. 0: a landing loses what the time scheme takes from it
    pub damping: f64,
    /// wire radius, m
    pub radius: f64,
    /// totals of what was lost
    pub loss: ContactLoss,
    /// work that the energy balance ascribes to touches which ended within the step, and that they did not do, J
    pub lifted: f64,
    /// take the friction limits of the iterate before. A guess may lie deep in what it lands on; friction from
    /// such a normal force would throw the wire sideways.
    pub hold_limits: bool,
    /// frozen wire lies within this distance of the core, m
    pub height: f64,
    /// depth of the deepest touch at any accepted instant, m
    pub deepest: f64,
    /// live wire on live wire, where it may touch
    pub self_contact: Option<SelfContact>,
    /// the points with surfaces near them at the last evaluation
    pub(super) near: Vec<NearPoint>,
    #[expect(
        clippy::vec_box,
        reason = "they are large, and nodes come and go in the middle"
    )]
    pub(super) points: Vec<Box<PointState>>,
    /// points whose surroundings this attempt at a step looked up, as they were
    pub(super) undo: Vec<(u32, PointState)>,
    /// room for the segments that a search finds
    pub(super) found: Vec<u32>,
}

impl LineContact {
    /// Contact of a wire with so many nodes and this `radius` (m), which touches nothing yet; no frozen wire.
    pub fn new(shape: Shape, law: ContactLaw, radius: f64, nodes: usize) -> Self {
        Self {
            shape,
            tube: SplineTube::new(radius),
            law,
            onset: ONSET,
            damping: 0.0,
            radius,
            loss: ContactLoss::default(),
            lifted: 0.0,
            hold_limits: false,
            height: 0.0,
            deepest: 0.0,
            self_contact: None,
            near: Vec::new(),
            points: vec![Box::new(PointState::NEW); 2 * nodes],
            undo: Vec::with_capacity(256),
            found: Vec::with_capacity(64),
        }
    }

    /// Follows the split of edge `j`: the state of its middle becomes that of the new node `j + 1`, and the middles
    /// of both halves are new. The pairs of live wire are numbered otherwise, see [`ContactPoint`].
    pub fn split(&mut self, j: usize) {
        let middle = ContactPoint::Edge(j).number();
        self.points.insert(middle, Box::new(PointState::NEW));
        self.points.insert(middle + 2, Box::new(PointState::NEW));
        if let Some(pairs) = &mut self.self_contact {
            pairs.split(j);
        }
    }

    /// Follows the merger of the edges at node `i`: the state of its point becomes that of the middle of the
    /// joined edge.
    pub fn merge(&mut self, i: usize) {
        self.points.remove(ContactPoint::Edge(i).number());
        self.points.remove(ContactPoint::Edge(i - 1).number());
        if let Some(pairs) = &mut self.self_contact {
            pairs.merge(i);
        }
    }

    /// Takes out the points of the first `count` nodes, which froze.
    pub fn remove_front(&mut self, count: usize) {
        self.points.drain(..2 * count);
        if let Some(pairs) = &mut self.self_contact {
            pairs.remove_front(count);
        }
    }

    /// State of node `i`'s point and the middle of the edge after it, for [`Self::insert_front`].
    pub fn memory(&self, i: usize) -> ContactRecord {
        ContactRecord::of(&self.points[2 * i..2 * i + 2])
    }

    /// Puts the points of nodes that thawed back at the front, from the records that they froze with, clamp first.
    pub fn insert_front(&mut self, nodes: impl DoubleEndedIterator<Item = ContactRecord>) {
        let mut count = 0;
        for record in nodes.rev() {
            self.points.splice(0..0, record.points().map(Box::new));
            count += 1;
        }
        if let Some(pairs) = &mut self.self_contact {
            pairs.insert_front(count);
        }
    }

    /// Moves point `k` to `p`, m, together with its anchors: it did not slide there.
    pub fn carry(&mut self, k: usize, p: V3) {
        let point = &mut self.points[k];
        if point.placed {
            let way = p - point.last;
            for t in &mut point.touch {
                t.anchor += way;
            }
            point.last = p;
        }
        point.reach = -1.0;
    }

    /// Sets the place of point `k` at the last accepted instant to `p`, m, if it has none.
    pub fn place(&mut self, k: usize, p: V3) {
        let point = &mut self.points[k];
        if !point.placed {
            point.last = p;
            point.placed = true;
        }
    }

    /// Adds a node at `point` (m), `arc` of unstretched wire (m) from the clamp, to the frozen wire.
    pub fn lay(&mut self, point: V3, arc: f64) {
        self.height = self
            .height
            .max(self.shape.nearness(point).distance + self.radius);
        self.tube.push(point, arc);
    }

    /// Lets the spline of the frozen wire continue into the first two live nodes: their places (m) and unstretched
    /// lengths from the clamp (m), the clamp's first. With `None` it ends, and nodes can be added or taken up.
    pub fn go_on(&mut self, ahead: Option<[(V3, f64); 2]>) {
        self.tube.go_on(ahead);
        self.mark_seam();
    }

    /// Tells the pairs of live wire whether the live wire begins at a seam with frozen wire.
    fn mark_seam(&mut self) {
        if let Some(pairs) = &mut self.self_contact {
            pairs.has_seam = self.tube.ahead().is_some();
        }
    }

    /// Lets live wire touch live wire from now on.
    pub fn watch_live_wire(&mut self) {
        self.self_contact.get_or_insert_default();
        self.mark_seam();
    }

    /// Couplings of nodes on touching live wires, by the last evaluation; see [`Coupling`].
    pub fn couplings(&self) -> &[Coupling] {
        self.self_contact.as_ref().map_or(&[], |s| &s.couplings)
    }

    /// Depth of the deepest touch of node `i` and the middles of its edges, m; 0: none.
    pub fn depth(&self, i: usize) -> f64 {
        let from = (2 * i).saturating_sub(1);
        self.points[from..=2 * i + 1]
            .iter()
            .flat_map(|p| p.touch.iter())
            .map(|t| t.depth)
            .fold(0.0, f64::max)
    }

    /// Whether node `i` or the middle of an edge at it touches core or frozen wire.
    pub fn touches(&self, i: usize) -> bool {
        self.depth(i) > 0.0
    }
}
