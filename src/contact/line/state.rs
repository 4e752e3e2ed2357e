//! What contact along the wire remembers, and how it follows changes of the wire.

use super::model::LineModel;
use super::point::{FLANGE, PointState, WIRE};
use super::record::ContactRecord;
use super::touch::TouchState;
use crate::contact::friction::LimitFrom;
use crate::contact::law::ContactLoss;
use crate::contact::self_contact::SelfContact;
use crate::contact::stencil::ContactPoint;
use crate::geometry::FLANGE_FACE;
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// State of each contact point of the live wire, and totals of what was lost.
///
/// Points are numbered as [`ContactPoint`] says; `k` stands for such a number. Places are in the core frame.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LineState {
    #[expect(
        clippy::vec_box,
        reason = "they are large, and nodes come and go in the middle"
    )]
    pub(super) points: Vec<Box<PointState>>,
    /// totals of what was lost
    pub loss: ContactLoss,
    /// depth of the deepest touch at the last accepted instant, m
    pub deepest: f64,
    /// frozen wire lies within this distance of the core, m; wire that thawed counts as well
    pub height: f64,
    /// places (m) and unstretched lengths from the clamp (m) of the live nodes into which the frozen wire's spline
    /// continues, the clamp's first
    pub(super) ahead: Option<[(V3, f64); 2]>,
    /// which friction limits an evaluation takes
    #[serde(skip)]
    pub limit_from: LimitFrom,
    /// live wire on live wire, where it may touch
    pub self_contact: Option<SelfContact>,
}

impl LineState {
    /// State of a wire with so many nodes, which touches nothing yet; no frozen wire.
    pub fn new(nodes: usize) -> Self {
        Self {
            points: vec![Box::new(PointState::NEW); 2 * nodes],
            loss: ContactLoss::default(),
            deepest: 0.0,
            height: 0.0,
            ahead: None,
            limit_from: LimitFrom::default(),
            self_contact: None,
        }
    }

    /// Becomes a copy of another state, in the room that this one has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let Self {
            points,
            loss,
            deepest,
            height,
            ahead,
            limit_from,
            self_contact,
        } = other;
        self.points.truncate(points.len());
        let mut from = points.iter();
        for (to, from) in self.points.iter_mut().zip(&mut from) {
            to.copy_from(from);
        }
        self.points.extend(from.cloned());
        (self.loss, self.deepest, self.height) = (*loss, *deepest, *height);
        (self.ahead, self.limit_from) = (*ahead, *limit_from);
        self.self_contact.clone_from(self_contact);
    }

    /// Follows the split of edge `j`: the state of its middle becomes that of the new node `j + 1`, and the middles
    /// of both halves are new.
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
            for slot in point.slots() {
                point.touch[slot].anchor += way;
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

    /// Tells the pairs of live wire whether the live wire begins at a seam with frozen wire.
    pub(super) fn mark_seam(&mut self) {
        if let Some(pairs) = &mut self.self_contact {
            pairs.has_seam = self.ahead.is_some();
        }
    }

    /// Lets live wire touch live wire from now on.
    pub fn watch_live_wire(&mut self) {
        self.self_contact.get_or_insert_default();
        self.mark_seam();
    }

    /// Depth of the deepest touch of node `i` and the middles of its edges, m; 0: none.
    pub fn depth(&self, i: usize) -> f64 {
        self.points[ContactPoint::around(i)]
            .iter()
            .flat_map(|p| p.touch.iter())
            .map(|t| t.depth)
            .fold(0.0, f64::max)
    }

    /// Whether node `i` or the middle of an edge at it touches core or frozen wire.
    pub fn touches(&self, i: usize) -> bool {
        // (most have nothing near them, and searches for the last one that touches go through all of these)
        self.points[ContactPoint::around(i)]
            .iter()
            .any(|p| Self::is_touched(p))
    }

    /// Whether node `i` itself does, and not only the middle of an edge at it.
    pub fn touches_itself(&self, i: usize) -> bool {
        Self::is_touched(&self.points[ContactPoint::Node(i).number()])
    }

    fn is_touched(point: &PointState) -> bool {
        point.has_surroundings() && point.touches().iter().any(|t| t.depth > 0.0)
    }

    /// The same without flanges: those of the `model`, or walls of its mesh that face along y.
    pub fn touches_wound(&self, model: &LineModel, i: usize) -> bool {
        let by_key = model.shape.with_walls().is_none();
        self.points[ContactPoint::around(i)]
            .iter()
            .filter(|p| p.has_surroundings())
            .any(|p| {
                let mut touches = p.touches().iter().enumerate();
                touches.any(|(slot, t)| {
                    let flange = match slot {
                        FLANGE if by_key => true,
                        wall => !by_key && wall < WIRE && t.normal.y.abs() > FLANGE_FACE,
                    };
                    t.depth > 0.0 && !flange
                })
            })
    }

    /// Makes the friction limits of the iterate in hand the lagged ones; call when an iterate is accepted.
    pub fn renew_limits(&mut self) {
        if let Some(pairs) = &mut self.self_contact {
            pairs.renew_limits();
        }
        for p in &mut self.points {
            if p.has_surroundings() {
                for t in p.touches_mut() {
                    t.limit.lagged = t.limit.current;
                }
            }
        }
    }

    /// Makes every point look its surroundings up again.
    pub fn forget_surroundings(&mut self) {
        for p in &mut self.points {
            p.reach = -1.0;
        }
    }

    /// What is impossible about a saved state of a wire with so many live `nodes` behind `frozen` ones, the last of
    /// them at that place (m) and unstretched length from the clamp (m). No edge is as long as `far` (m).
    pub(crate) fn check(
        &self,
        nodes: usize,
        frozen: usize,
        mut last: Option<(V3, f64)>,
        far: f64,
    ) -> Result<(), &'static str> {
        for (point, arc) in self.ahead.into_iter().flatten() {
            let sound = last.is_some_and(|(before, so_far)| {
                let way = (point - before).norm();
                way > 0.0 && way < far && arc >= so_far
            });
            if !sound {
                return Err("frozen wire goes on as none");
            }
            last = Some((point, arc));
        }
        let controls = (frozen + self.ahead.map_or(0, |ahead| ahead.len())) as u32;
        if self.points.len() != 2 * nodes {
            return Err("contact points do not go with the nodes");
        }
        for p in &self.points {
            let touches = p.touch.get(WIRE..WIRE + p.passages);
            let all = touches.ok_or("a contact point has too many touches")?;
            if p.reach >= 0.0 && all.iter().any(|t| t.start >= controls) {
                return Err("a touch is beyond the frozen wire");
            }
            if !p.has_surroundings() && !p.touch.iter().all(TouchState::is_unused) {
                return Err("a contact point touches what it is not near");
            }
        }
        if !self.self_contact.as_ref().is_none_or(|s| s.fits(nodes)) {
            return Err("a pair is beyond the live wire");
        }
        Ok(())
    }

    /// Energy stored in the touches of point `k`, which stands for `length` (m), J. Touches that a change of the wire has
    /// just brought about count as well; no bristle holds them yet.
    pub fn stored(&self, model: &LineModel, k: usize, length: f64) -> f64 {
        self.points[k].stored(model, length)
    }
}
