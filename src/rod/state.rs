//! The rod's state: the least that restarts it.

use super::plasticity::{Bend, Scalar};
use super::section::Section;
use crate::math::frame_along;
use crate::math::{Quat, V3};
use serde::{Deserialize, Serialize};

/// Positions, velocities, frames and plastic state of a rod of `n + 1` nodes and `n` edges, lab
/// frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rod {
    /// node positions, m
    pub x: Vec<V3>,
    /// node velocities, m/s
    pub v: Vec<V3>,
    /// unstretched edge lengths, m
    pub rest: Vec<f64>,
    /// edge frames, body z along the edge
    pub frame: Vec<Quat>,
    /// angular velocity of the edge about its own axis, rad/s
    pub spin: Vec<f64>,
    /// plastic stretch per edge
    pub stretch: Vec<Scalar>,
    /// plastic bending per joint (node)
    pub bend: Vec<Bend>,
    /// plastic twist per joint (node)
    pub twist: Vec<Scalar>,
    /// Voronoi length moved from the first joint to the second by [`Rod::refine_clamp`], m; 0 in
    /// every scene
    #[serde(skip)]
    pub lead: f64,
}

impl Rod {
    /// Becomes a copy of another, in the room that this one has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let Self {
            x,
            v,
            rest,
            frame,
            spin,
            stretch,
            bend,
            twist,
            lead,
        } = other;
        self.x.clone_from(x);
        self.v.clone_from(v);
        self.rest.clone_from(rest);
        self.frame.clone_from(frame);
        self.spin.clone_from(spin);
        self.stretch.clone_from(stretch);
        self.bend.clone_from(bend);
        self.twist.clone_from(twist);
        self.lead = *lead;
    }

    /// Rod through these points, unstretched unless `rest` says otherwise, untwisted, at rest,
    /// with no plastic strain. The stress-free shape is straight.
    pub fn through(points: &[V3], rest: Option<Vec<f64>>) -> Self {
        let edges = points.len().saturating_sub(1);
        let lengths: Vec<f64> = points.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
        let mut frame: Vec<Quat> = Vec::with_capacity(edges);
        for j in 0..edges {
            let t = (points[j + 1] - points[j]) / lengths[j];
            frame.push(frame_along(&t, frame.last()));
        }
        Self {
            x: points.to_vec(),
            v: vec![V3::zeros(); points.len()],
            rest: rest.unwrap_or(lengths),
            frame,
            spin: vec![0.0; edges],
            stretch: vec![Scalar::default(); edges],
            bend: vec![Bend::default(); points.len()],
            twist: vec![Scalar::default(); points.len()],
            lead: 0.0,
        }
    }

    /// Length of the first edge over that of all others with which a clamp at the start is exact to
    /// one order more after [`Rod::refine_clamp`].
    #[cfg(feature = "lab")]
    pub const FIRST_EDGE: f64 = std::f64::consts::FRAC_1_SQRT_2;

    /// Makes a clamp at the start exact to third order: fourth if the first edge is
    /// [`Rod::FIRST_EDGE`] of the next.
    ///
    /// A joint bends the wire as much as its Voronoi length. So slope and position of clamped wire
    /// are quadratures over the joints by the trapezoid rule. Its error comes from the end:
    /// `h^2/12` of the integrand's slope there, or `h^2/6` of the wire's change of curvature as an
    /// angle all along the wire. Moving a share of the first joint to the second removes it
    /// (Gregory's rule, with weights 5/12 and 13/12 for even edges). A first edge shorter by
    /// `1/sqrt 2` removes the next term too, from `a + b = l0 + h/2`,
    /// `b l0 = (l0^2 + h l0)/2 + h^2/12`, `b l0^2 = l0 (l0 + h)(2 l0 + h)/6`.
    #[cfg(feature = "lab")]
    pub fn refine_clamp(&mut self) {
        if let [first, second, ..] = self.rest[..] {
            self.lead = second * second / (12.0 * first);
        }
    }

    /// Number of edges.
    pub fn edges(&self) -> usize {
        self.rest.len()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.x.len()
    }

    /// Voronoi length of joint `i`, m: half of each neighbouring edge (at an end of the one edge),
    /// with [`Rod::lead`] moved from the first joint to the second.
    #[inline]
    pub fn voronoi(&self, i: usize) -> f64 {
        // (nearly all are inner ones)
        if i > 1 && i < self.rest.len() {
            return 0.5 * (self.rest[i - 1] + self.rest[i]);
        }
        let before = if i > 0 { self.rest[i - 1] } else { 0.0 };
        let after = if i < self.edges() { self.rest[i] } else { 0.0 };
        let lead = match i {
            0 => -self.lead,
            1 => self.lead,
            _ => 0.0,
        };
        0.5 * (before + after) + lead
    }

    /// Unit direction of edge `j`.
    pub fn tangent(&self, j: usize) -> V3 {
        let d = self.x[j + 1] - self.x[j];
        d / d.norm()
    }

    /// Turns every frame onto the present direction of its edge, the shortest way.
    #[cfg(any(test, feature = "lab"))]
    pub fn realign(&mut self) {
        use crate::math::{align, rotate};
        for j in 0..self.edges() {
            let t = self.tangent(j);
            let q = if rotate(&self.frame[j], &V3::z()).dot(&t) < -0.99 {
                frame_along(&t, Some(&self.frame[j]))
            } else {
                align(&self.frame[j], &t, 0.0)
            };
            self.frame[j] = q;
        }
    }

    /// Lumped mass of node `i`, kg.
    #[inline]
    pub fn mass(&self, section: &Section, i: usize) -> f64 {
        section.mass_per_length() * self.voronoi(i)
    }
}
