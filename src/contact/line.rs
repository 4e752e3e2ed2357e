//! Line contact of the implicit solver: smooth core, smooth frozen turns, friction with memory.
//!
//! The wire touches at two points per node, one on the quadratic B-spline of the nodes at each node
//! and one at the middle of each edge, so that a coarse polygon neither cuts a corner nor hooks on
//! a kink. Everything is in the core frame. The normal force has a smooth onset; friction is a
//! bristle from an anchor, cut off at the friction coefficient times a *lagged* normal force, so
//! that for given lags normal and tangential force derive from one potential. The lag is renewed
//! with every iterate, so the converged step has none left.

use super::between::Between;
use super::law::{ContactLaw, TANGENTIAL_SHARE};
use super::point::{FRESH, Memory, PASSAGES, Point};
use super::touch::{
    Circumstances, Limit, NONE, Push, Touch, bristle, damped_law, less, onset_law, times, unstored,
};
use super::{ContactLoss, OWN_WIRE};
use crate::geometry::Shape;
use crate::geometry::SplineTube;
use crate::math::V3;
use crate::rod::Block;
use serde::{Deserialize, Serialize};

/// A point's surroundings are looked up again after this way, in wire diameters.
const SKIN: f64 = 0.15;
/// Error of a contact force that an update may promise, as a depth, m, for wire of 0.7 mm; see [`foresight`].
const FORESIGHT: f64 = 1e-7;
/// Change of an update that nothing new can come of, as a share of that.
const SAME: f64 = 0.2;
/// Depth over which the normal force sets in, m. Ten times as much takes a tenth off the evaluations, and adds
/// 4.5 um to the depth at rest.
const ONSET: f64 = 1e-6;

/// The wire's contact points and what they can touch.
#[derive(Clone, Debug)]
pub struct LineContact {
    /// the core
    pub shape: Shape,
    /// frozen turns; they grow by [`Self::lay`]
    pub tube: SplineTube,
    /// the law
    pub law: ContactLaw,
    /// depth over which the normal force sets in, m
    pub onset: f64,
    /// line load per rate of depth, N s/m^2, and as much of it along the surface as of the stiffness; it
    /// never pulls. 0: what the method itself takes out of a blow
    pub damping: f64,
    /// wire radius, m
    pub radius: f64,
    /// totals of what was lost
    pub loss: ContactLoss,
    /// work that touches which ended in the step in hand seem to do by their forces at its ends, J
    pub lifted: f64,
    /// take the friction limits of the iterate before instead of the present one's. A guess may be deep
    /// in what it lands on; friction from such a normal force would throw the wire sideways.
    pub hold_limits: bool,
    /// frozen wire lies within this of the core, m
    pub height: f64,
    /// deepest touch of any accepted instant, m
    pub deepest: f64,
    /// live wire against live wire, where they may meet
    pub between: Option<Between>,
    /// every surface near a point at the last evaluation
    near: Vec<Near>,
    #[expect(
        clippy::vec_box,
        reason = "they are large, and nodes come and go in the middle"
    )]
    points: Vec<Box<Point>>,
    /// points whose surroundings this attempt at a step looked up, as they were
    undo: Vec<(u32, Point)>,
    found: Vec<u32>,
}

/// The part of [`LineContact`] that neither the scene nor the frozen wire gives.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedLine {
    #[expect(clippy::vec_box, reason = "those of the line")]
    points: Vec<Box<Point>>,
    loss: ContactLoss,
    deepest: f64,
    /// wire that was taken back counts as well
    height: f64,
    /// nodes with which the frozen wire goes on
    ahead: Option<[(V3, f64); 2]>,
    hold_limits: bool,
    between: Option<Between>,
}

/// A point with surfaces near it: how the linear system sees their push.
#[derive(Clone, Copy, Debug)]
struct Near {
    point: u32,
    /// length of wire it stands for, m
    length: f64,
    /// where the iterate has it
    place: V3,
    /// gradient there, N, and Hessian, N/m
    gradient: V3,
    hessian: Block,
    /// way from there without any push, while it has none, m
    room: f64,
    /// way that was looked ahead along last, m; none: gradient and Hessian are those of `place`
    seen: Option<V3>,
}

impl LineContact {
    /// Nothing touches yet.
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
            between: None,
            near: Vec::new(),
            points: vec![Box::new(FRESH); 2 * nodes],
            undo: Vec::with_capacity(256),
            found: Vec::with_capacity(64),
        }
    }

    /// What a saved state has to hold.
    pub(crate) fn saved(&self) -> SavedLine {
        // a new field asks here whether it is state
        let Self {
            shape: _,
            tube: _,
            law: _,
            onset: _,
            damping: _,
            radius: _,
            loss,
            lifted: _,
            hold_limits,
            height,
            deepest,
            between,
            near: _,
            points,
            undo: _,
            found: _,
        } = self;
        SavedLine {
            points: points.clone(),
            loss: *loss,
            deepest: *deepest,
            height: *height,
            ahead: self.tube.ahead(),
            hold_limits: *hold_limits,
            between: between.clone(),
        }
    }

    /// Goes back to what was saved when the frozen wire and the number of live nodes were what they are.
    pub(crate) fn take_back(&mut self, saved: SavedLine) {
        self.points = saved.points;
        self.between = saved.between;
        (self.loss, self.deepest) = (saved.loss, saved.deepest);
        (self.height, self.hold_limits) = (saved.height, saved.hold_limits);
    }

    /// Takes a saved state over; `wire` is the frozen wire, places and arc lengths, and `nodes` the number of
    /// live ones. No edge is as long as `far`. Says what is impossible about it.
    pub(crate) fn restore(
        &mut self,
        saved: SavedLine,
        wire: impl Iterator<Item = (V3, f64)>,
        nodes: usize,
        far: f64,
    ) -> Result<(), &'static str> {
        let mut fresh = Self::new(self.shape.clone(), self.law, self.radius, nodes);
        wire.for_each(|(point, arc)| fresh.lay(point, arc));
        let mut last = (fresh.tube.points().last().copied()).zip(fresh.tube.arc().last().copied());
        for (point, arc) in saved.ahead.into_iter().flatten() {
            let sound = last.is_some_and(|(before, so_far)| {
                let way = (point - before).norm();
                way > 0.0 && way < far && arc >= so_far
            });
            if !sound {
                return Err("frozen wire goes on as none");
            }
            last = Some((point, arc));
        }
        fresh.tube.go_on(saved.ahead);
        let frozen = fresh.tube.controls().len() as u32;
        if saved.points.len() != 2 * nodes {
            return Err("contact points do not go with the nodes");
        }
        for p in &saved.points {
            let touches = p.touch.get(1..=p.passages);
            let all = touches.ok_or("a contact point has too many touches")?;
            if p.reach >= 0.0 && all.iter().any(|t| t.start >= frozen) {
                return Err("a touch is beyond the frozen wire");
            }
        }
        if !saved.between.as_ref().is_none_or(|b| b.fits(nodes)) {
            return Err("a pair is beyond the live wire");
        }
        (fresh.points, fresh.between) = (saved.points, saved.between);
        (fresh.loss, fresh.deepest) = (saved.loss, saved.deepest);
        (fresh.height, fresh.hold_limits) = (saved.height, saved.hold_limits);
        *self = fresh;
        Ok(())
    }

    /// Forgets lags and surroundings so that a run can be repeated from here to the bit.
    pub fn forget_surroundings(&mut self) {
        for p in &mut self.points {
            p.reach = -1.0;
        }
    }

    /// Points that come near frozen wire from node `from` on look their surroundings up anew: that wire has just been
    /// laid.
    pub fn forget_near(&mut self, from: usize) {
        let skin = SKIN * 2.0 * self.tube.radius();
        let wire = self.radius + self.tube.radius();
        // the node before got its share of the curve changed as well
        let laid = &self.tube.controls()[from.saturating_sub(2)..];
        for p in &mut self.points {
            let reach = wire + p.reach.max(skin);
            let near = |ends: &[V3]| {
                let (middle, length) = ((ends[0] + ends[1]) * 0.5, (ends[1] - ends[0]).norm());
                (middle - p.centre).norm() < reach + length
            };
            if p.reach >= 0.0 && laid.windows(2).any(near) {
                p.reach = -1.0;
            }
        }
    }

    /// A node was put in the middle of edge `j`: its point of contact becomes the node's.
    pub fn split(&mut self, j: usize) {
        // edge j's middle (2j + 1) turns into the new node's point, with new middles either side
        self.points.insert(2 * j + 1, Box::new(FRESH));
        self.points.insert(2 * j + 3, Box::new(FRESH));
        if let Some(b) = &mut self.between {
            b.split(j);
        }
    }

    /// The first `count` nodes left.
    pub fn remove_front(&mut self, count: usize) {
        self.points.drain(..2 * count);
        if let Some(b) = &mut self.between {
            b.remove_front(count);
        }
    }

    /// What the two points of node `i` (its own and the middle of the edge after it) remember.
    pub fn memory(&self, i: usize) -> Memory {
        Memory::of(&self.points[2 * i..2 * i + 2])
    }

    /// Nodes came back at the front with what their points remembered, clamp first.
    pub fn insert_front(&mut self, nodes: impl DoubleEndedIterator<Item = Memory>) {
        let mut count = 0;
        for memory in nodes.rev() {
            self.points.splice(0..0, memory.points().map(Box::new));
            count += 1;
        }
        if let Some(b) = &mut self.between {
            b.insert_front(count);
        }
    }

    /// Node `i` was taken out.
    pub fn merge(&mut self, i: usize) {
        // its own point becomes the middle of the joined edge
        self.points.remove(2 * i + 1);
        self.points.remove(2 * i - 1);
        if let Some(b) = &mut self.between {
            b.merge(i);
        }
    }

    /// Contact point `k` is at `p` now, without having slid there.
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

    /// Wire comes to rest at `point`, `arc` of unstretched wire from the clamp.
    pub fn lay(&mut self, point: V3, arc: f64) {
        self.height = self
            .height
            .max(self.shape.nearness(point).distance + self.radius);
        self.tube.push(point, arc);
    }

    /// From here on the frozen wire goes on with these live nodes, core frame and unstretched lengths from the clamp, the clamp's first; with
    /// `None` it ends, and more of it can be laid or taken up.
    pub fn go_on(&mut self, ahead: Option<[(V3, f64); 2]>) {
        self.tube.go_on(ahead);
        self.meet();
    }

    /// Tells live wire whether it begins at a seam.
    fn meet(&mut self) {
        if let Some(between) = &mut self.between {
            between.goes_on = self.tube.ahead().is_some();
        }
    }

    /// From now on live wire may touch live wire.
    pub fn watch_live_wire(&mut self) {
        self.between.get_or_insert_default();
        self.meet();
    }

    /// Depth of the deepest touch of node `i` and the halves of its edges, m; 0: none.
    pub fn depth(&self, i: usize) -> f64 {
        let from = (2 * i).saturating_sub(1);
        self.points[from..=2 * i + 1]
            .iter()
            .flat_map(|p| p.touch.iter())
            .map(|t| t.depth)
            .fold(0.0, f64::max)
    }

    /// Whether node `i` or the wire next to it touches anything.
    pub fn touches(&self, i: usize) -> bool {
        self.depth(i) > 0.0
    }

    /// Puts the present place of a point on record if it is new.
    pub fn place(&mut self, point: usize, p: V3) {
        let point = &mut self.points[point];
        if !point.placed {
            point.last = p;
            point.placed = true;
        }
    }

    /// An attempt at a step begins.
    pub fn begin_attempt(&mut self) {
        self.undo.clear();
    }

    /// The attempt failed: everything it changed becomes what it was.
    pub fn undo_attempt(&mut self) {
        for (k, point) in self.undo.drain(..).rev() {
            *self.points[k as usize] = point;
        }
        for p in &mut self.points {
            if p.core_near || p.passages > 0 {
                for t in &mut p.touch[..=p.passages] {
                    t.lag = t.kept;
                }
            }
        }
    }

    fn look_up(&mut self, k: usize, p: V3, own: f64) {
        let skin = SKIN * 2.0 * self.tube.radius();
        let point = &mut self.points[k];
        self.undo.push((k as u32, **point));
        point.centre = p;
        point.clear = 0.0;
        let core = self.shape.lower_bound(p);
        let core = if core > skin + self.radius {
            core
        } else {
            self.shape.nearness(p).distance
        };
        let core_room = core - self.radius;
        point.core_near = core_room < skin;
        if !point.core_near {
            point.touch[0] = NONE;
        }
        let wire = self.radius + self.tube.radius();
        // above all wire that has been laid there is nothing to look for; else the search ball must not get large
        let above = core_room - self.height;
        let reach = if above > skin {
            above
        } else {
            (core_room + skin).clamp(skin, 4.0 * skin)
        };
        self.found.clear();
        if self.tube.len() > 1 && above <= skin {
            self.tube.gather(p, wire + reach, own, &mut self.found);
        }
        let mut next = [NONE; PASSAGES];
        let mut count = 0;
        let mut nearest = f64::INFINITY;
        for &start in &self.found {
            let foot = self.tube.foot(p, start);
            nearest = nearest.min(-foot.depth(wire));
            if -foot.depth(wire) > skin || count == PASSAGES {
                continue;
            }
            // the passage keeps its friction: it is the one whose segment is close by along the wire
            let known = point.touch[1..=point.passages]
                .iter()
                .filter(|t| t.start.abs_diff(foot.segment) < 6)
                .min_by_key(|t| t.start.abs_diff(foot.segment));
            next[count] = known.copied().unwrap_or(NONE);
            next[count].start = foot.segment;
            count += 1;
        }
        point.touch[1..].copy_from_slice(&next);
        point.passages = count;
        let wire_room = nearest.min(reach);
        let room = if point.core_near { 0.0 } else { core_room }.min(if count > 0 {
            0.0
        } else {
            wire_room
        });
        point.reach = if room > 0.0 { room } else { skin };
    }

    /// Potential, gradient and Hessian of point `k` at `p` standing for `length` of wire.
    ///
    /// `own` is the unstretched length beyond which frozen wire counts as the point's own
    /// neighbourhood; `step` the time since the last accepted instant. `None` where nothing touches.
    #[inline]
    pub fn push(&mut self, k: usize, p: V3, length: f64, own: f64, step: f64) -> Option<Push> {
        let point = &self.points[k];
        if point.reach < 0.0 || (p - point.centre).norm_squared() >= point.reach * point.reach {
            self.look_up(k, p, own);
        }
        let point = &self.points[k];
        if !point.core_near && point.passages == 0 {
            return None;
        }
        if point.clear > 0.0 {
            let way = (p - point.free).norm();
            if way < point.clear {
                self.near.push(Near {
                    point: k as u32,
                    length,
                    place: p,
                    gradient: V3::zeros(),
                    hessian: Block::default(),
                    room: point.clear - way,
                    seen: None,
                });
                return None;
            }
        }
        self.touches_of(k, p, length, step)
    }

    fn touches_of(&mut self, k: usize, p: V3, length: f64, step: f64) -> Option<Push> {
        let Self {
            points,
            tube,
            shape,
            law,
            onset,
            damping,
            radius,
            hold_limits,
            near,
            ..
        } = self;
        let point = &mut points[k];
        let around = Circumstances {
            law,
            onset: *onset,
            stiffness: law.stiffness * length,
            brake: *damping / (law.stiffness * step),
            step,
            last: point.last,
            limit: if *hold_limits {
                Limit::Lagged
            } else {
                Limit::Own
            },
        };
        let mut sum = Push::default();
        let mut any = false;
        let mut gap = f64::INFINITY;
        for slot in 0..=point.passages {
            let (depth, normal) = if slot == 0 {
                if !point.core_near {
                    continue;
                }
                let n = shape.nearness(p);
                (*radius - n.distance, n.normal)
            } else {
                let foot = tube.foot(p, point.touch[slot].start);
                point.touch[slot].start = foot.segment;
                // inside a sharp bend two feet merge as the point moves: that is one touch
                if point.touch[1..slot].iter().any(|t| t.start == foot.segment) {
                    (point.touch[slot].depth, point.touch[slot].fresh) = (0.0, 0.0);
                    continue;
                }
                (foot.depth(*radius + tube.radius()), foot.normal)
            };
            let touch = &mut point.touch[slot];
            touch.depth = depth;
            touch.normal = normal;
            if depth <= 0.0 {
                touch.fresh = 0.0;
                gap = gap.min(-depth);
                continue;
            }
            any = true;
            (touch.fresh, touch.slide) = touch.push(p, &around, &mut sum);
        }
        (point.free, point.clear) = (p, if any { 0.0 } else { gap });
        near.push(Near {
            point: k as u32,
            length,
            place: p,
            gradient: sum.gradient,
            hessian: sum.hessian,
            room: point.clear,
            seen: None,
        });
        any.then_some(sum)
    }

    /// The push on point `k` at a place that an update leads to, as far as its surroundings are known.
    fn push_there(&mut self, k: usize, p: V3, length: f64, step: f64) -> Push {
        let point = &mut self.points[k];
        let around = Circumstances {
            law: &self.law,
            onset: self.onset,
            stiffness: self.law.stiffness * length,
            brake: self.damping / (self.law.stiffness * step),
            step,
            last: point.last,
            limit: Limit::Latest,
        };
        let mut sum = Push::default();
        for slot in 0..=point.passages {
            let touch = point.touch[slot];
            if slot > 0 && point.touch[1..slot].iter().any(|t| t.start == touch.start) {
                continue;
            }
            let (depth, normal) = if slot == 0 {
                if !point.core_near {
                    continue;
                }
                let n = self.shape.nearness(p);
                (self.radius - n.distance, n.normal)
            } else {
                let foot = self.tube.foot(p, touch.start);
                let wire = self.radius + self.tube.radius();
                (foot.depth(wire), foot.normal)
            };
            if depth > 0.0 {
                let there = Touch {
                    depth,
                    normal,
                    ..touch
                };
                point.touch[slot].slide = there.push(p, &around, &mut sum).1;
            }
        }
        sum
    }

    /// Forgets what was near before a new evaluation.
    pub fn begin(&mut self) {
        self.near.clear();
    }

    /// Evaluates the pushes where the update `move_of(point)` leads every point, and puts their tangents
    /// there in the place of those that promised something else: `correct(point, change of Hessian, change
    /// of gradient at the iterate)`. Whether any did.
    ///
    /// A point on its way through a surface that the Hessian does not hold yet would otherwise be
    /// thrown back and forth, with all its neighbours on a flat; so would one that slides round a corner,
    /// or whose bristle comes to hold.
    #[inline(never)]
    pub fn predict(
        &mut self,
        step: f64,
        move_of: impl Fn(usize) -> V3,
        mut correct: impl FnMut(usize, &Block, &V3),
    ) -> bool {
        let mut any = false;
        let prediction_tolerance = prediction_tolerance(2.0 * self.radius);
        let same = SAME * prediction_tolerance;
        let mut near = std::mem::take(&mut self.near);
        for n in &mut near {
            let way = move_of(n.point as usize);
            let far = way.norm_squared();
            // no push, none that the way can change by more than what is let pass, or as good as where it was looked at
            // before and is right
            let still = n
                .seen
                .map_or(far <= prediction_tolerance * prediction_tolerance, |seen| {
                    (way - seen).norm_squared() <= same * same
                });
            if far < n.room * n.room || still {
                continue;
            }
            n.seen = Some(way);
            let there = self.push_there(n.point as usize, n.place + way, n.length, step);
            let off = there.gradient - n.gradient - times(&n.hessian, &way);
            if off.amax() <= prediction_tolerance * self.law.stiffness * n.length {
                continue;
            }
            any = true;
            let gradient = there.gradient - times(&there.hessian, &way);
            correct(
                n.point as usize,
                &less(&there.hessian, &n.hessian),
                &(gradient - n.gradient),
            );
            (n.gradient, n.hessian, n.room) = (gradient, there.hessian, 0.0);
        }
        self.near = near;
        any
    }

    /// Takes the friction limits of the iterate in hand over: call once an iterate is accepted.
    pub fn renew_lags(&mut self) {
        if let Some(b) = &mut self.between {
            b.renew_lags();
        }
        for p in &mut self.points {
            if p.core_near || p.passages > 0 {
                for t in &mut p.touch[..=p.passages] {
                    t.lag = t.fresh;
                }
            }
        }
    }

    /// Takes `p` over as the accepted place of point `k`: anchors move on, slip and blows are booked.
    /// Returns the force on the point, core frame, N.
    ///
    /// The books take half the sum of the forces at both ends of a step for what acted on its way. A touch that begins within the step
    /// acted for the last of the way only and stored what its law says: the rest of its work was taken from the motion for
    /// good, the blow of a landing, and of its slip half. One that ended acted at the beginning only.
    pub fn commit(&mut self, k: usize, p: V3, length: f64, own: f64, step: f64) -> V3 {
        let force = self
            .push(k, p, length, own, step)
            .map_or(V3::zeros(), |s| -s.gradient);
        let k_t = self.law.stiffness * length * TANGENTIAL_SHARE;
        let point = &mut self.points[k];
        let last = point.last;
        let stiffness = self.law.stiffness * length;
        for t in &mut point.touch[..=point.passages] {
            (t.lag, t.kept) = (t.fresh, t.fresh);
            let out = (p - last).dot(&t.normal);
            if t.depth <= 0.0 {
                if t.held && out >= t.before {
                    let (energy, force, _) = onset_law(t.before, self.onset);
                    self.lifted += stiffness * unstored(force, energy, out);
                }
                t.held = false;
                t.before = 0.0;
                continue;
            }
            let brake = self.damping / (self.law.stiffness * step);
            let lands = !t.held && -out >= t.depth;
            if lands || brake > 0.0 {
                let (energy, spring, _) = onset_law(t.depth, self.onset);
                let all = damped_law(t.depth, self.onset, brake, t.before).1;
                self.loss.damping += stiffness
                    * if lands {
                        unstored(all, energy, -out)
                    } else {
                        (all - spring) * (t.depth - t.before)
                    };
            }
            t.before = t.depth;
            self.deepest = self.deepest.max(t.depth);
            let (b, _) = bristle(t, p, last, k_t, 0.0);
            let (braked, k_braked) = bristle(t, p, last, k_t, brake);
            let (size, pull) = (b.norm(), k_braked * braked.norm());
            t.held = true;
            let share = if lands { 0.5 } else { 1.0 };
            t.anchor = p - b;
            if pull > t.fresh {
                // the spring's part of it, which a dashpot may have kept from stretching so far
                let kept = (t.fresh / k_t).min(size);
                let dir = braked * (k_braked / pull);
                t.anchor = p - dir * kept;
                self.loss.friction += share * t.fresh * (size - kept);
            }
        }
        point.last = p;
        force
    }

    /// Normal force of each touch of point `k` standing for `length` where it was last seen, core frame,
    /// N: the core's first, then those of frozen wire.
    pub fn normal_forces(&self, k: usize, length: f64) -> impl Iterator<Item = V3> + '_ {
        let k_n = self.law.stiffness * length;
        let point = &self.points[k];
        point.touch[..=point.passages]
            .iter()
            .filter(|t| t.depth > 0.0)
            .map(move |t| t.normal * (k_n * onset_law(t.depth, self.onset).1))
    }

    /// The contact point whose bristle pulls hardest against what friction may hold there at rest, and its pull
    /// over that limit (both go with the length of wire the point stands for, which so drops out).
    pub fn friction_over_limit(&self) -> (usize, f64) {
        let mut worst = (0, 0.0);
        for (k, point) in self.points.iter().enumerate() {
            for t in &point.touch[..=point.passages] {
                if t.depth > 0.0 && t.held {
                    let b = point.last - t.anchor;
                    let b = b - t.normal * b.dot(&t.normal);
                    let limit = self.law.mu_static * onset_law(t.depth, self.onset).1;
                    let pull = TANGENTIAL_SHARE * b.norm();
                    // a bristle shorter than rounding of places pulls on nothing
                    if pull > limit * worst.1 && b.norm() > 1e-15 {
                        worst = (k, pull / limit);
                    }
                }
            }
        }
        worst
    }

    /// Energy stored in the touches of point `k` standing for `length`, J; also in those that a change of the wire has just
    /// brought about, which no bristle holds yet.
    pub fn stored(&self, k: usize, length: f64) -> f64 {
        let k_n = self.law.stiffness * length;
        let point = &self.points[k];
        point.touch[..=point.passages]
            .iter()
            .filter(|t| t.depth > 0.0)
            .map(|t| {
                let pressed = k_n * onset_law(t.depth, self.onset).0;
                if !t.held {
                    return pressed;
                }
                let b = point.last - t.anchor;
                let b = b - t.normal * b.dot(&t.normal);
                pressed + 0.5 * k_n * TANGENTIAL_SHARE * b.norm_squared()
            })
            .sum()
    }
}

/// Error of a contact force that an update may promise, as a depth, m.
///
/// What presses wire on its core goes with its cross-section. With one depth for all, an update could promise
/// fine wire (0.05 mm) fifty times the force there was: Newton's method went to and fro, in steps of a microsecond.
pub(super) fn prediction_tolerance(diameter: f64) -> f64 {
    let size = diameter / 0.7e-3;
    FORESIGHT * (size * size).min(1.0)
}

/// Wire this far back along itself is the point's own neighbourhood.
pub fn own_wire(arc: f64, diameter: f64) -> f64 {
    arc - OWN_WIRE * diameter
}
