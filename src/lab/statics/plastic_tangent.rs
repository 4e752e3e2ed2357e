//! The tangent of yielding wire, for the search of equilibrium.
//!
//! The stiffness of a joint is `B^T C B lv` with `B` the derivative of its curvature and twist and
//! `C` that of its law, plus what the moment contributes as the joint turns. The second and all
//! of an elastic joint come from differences of forces under the elastic law; this file takes the
//! missing `B^T (C_elastic - C) B lv` off where the law yields.

use super::band::Band;
use super::unknowns::PER_NODE;
use crate::math::Quat;
use crate::math::align;
use crate::rod::{Bend, Joint, Laws, Scalar, Section, respond_bend, respond_scalar};
use crate::system::System;

/// Displacement in edge lengths, or rad, in the derivative of curvature and twist.
const NUDGE: f64 = 1e-5;
/// Share of strain in the derivative of a law.
const FINE: f64 = 1e-7;

/// Strains of one joint: two of bending, one of twist, 1/m.
type Strains = [f64; 3];

/// What one joint or edge lacks of the elastic stiffness.
#[derive(Clone, Copy, Debug)]
enum Lack {
    /// at a joint: bending, twist
    Joint(usize, [[f64; 2]; 2], f64),
    /// in an edge: stretch
    Edge(usize, f64),
}

/// Plastic state that gives the present forces under the elastic law, and what that law has too
/// much of stiffness.
pub(crate) struct Flows {
    bend: Vec<Bend>,
    twist: Vec<Scalar>,
    stretch: Vec<Scalar>,
    lacks: Vec<Lack>,
}

/// The state and laws to put back.
pub(crate) struct Plastic {
    bend: Vec<Bend>,
    twist: Vec<Scalar>,
    stretch: Vec<Scalar>,
    laws: Laws,
}

/// Whether any joint or edge is beyond its limit.
pub(crate) fn yields(sys: &System) -> bool {
    !Flows::of(sys).lacks.is_empty()
}

impl Flows {
    /// At the present place.
    pub(crate) fn of(sys: &System) -> Self {
        let mut flows = Self {
            bend: sys.state.rod.bend.clone(),
            twist: sys.state.rod.twist.clone(),
            stretch: sys.state.rod.stretch.clone(),
            lacks: Vec::new(),
        };
        let laws = &sys.model.laws;
        for i in 0..sys.state.rod.nodes() {
            let Some([k1, k2, k3]) = strains(sys, i) else {
                continue;
            };
            let (m, _, work) = respond_bend(&laws.bend, &sys.state.rod.bend[i], [k1, k2]);
            let (t, _, twist_work) = respond_scalar(&laws.twist, &sys.state.rod.twist[i], k3);
            let twists = sys.model.twist.is_carried() && twist_work > 0.0;
            let (mut bend, mut twist) = ([[0.0; 2]; 2], 0.0);
            if work > 0.0 {
                let (e, p) = (laws.bend.modulus, sys.state.rod.bend[i].curvature);
                let d = FINE * ((k1 - p[0]).abs() + (k2 - p[1]).abs());
                for a in 0..2 {
                    let at = |s: f64| {
                        let mut k = [k1, k2];
                        k[a] += s * d;
                        respond_bend(&laws.bend, &sys.state.rod.bend[i], k).0
                    };
                    let (ahead, behind) = (at(1.0), at(-1.0));
                    for b in 0..2 {
                        let elastic = if a == b { e } else { 0.0 };
                        bend[b][a] = elastic - (ahead[b] - behind[b]) / (2.0 * d);
                    }
                }
                flows.bend[i].curvature = [k1 - m[0] / e, k2 - m[1] / e];
            }
            if twists {
                twist = lack(&laws.twist, &sys.state.rod.twist[i], k3);
                flows.twist[i].strain = k3 - t / laws.twist.modulus;
            }
            if work > 0.0 || twists {
                flows.lacks.push(Lack::Joint(i, bend, twist));
            }
        }
        for j in 0..sys.state.rod.edges() {
            let strain =
                (sys.state.rod.x[j + 1] - sys.state.rod.x[j]).norm() / sys.state.rod.rest[j] - 1.0;
            let (n, _, work) = respond_scalar(&laws.stretch, &sys.state.rod.stretch[j], strain);
            if work > 0.0 {
                flows.stretch[j].strain = strain - n / laws.stretch.modulus;
                let lack = lack(&laws.stretch, &sys.state.rod.stretch[j], strain);
                flows.lacks.push(Lack::Edge(j, lack));
            }
        }
        flows
    }

    /// Gives the system the elastic law at the same forces.
    pub(crate) fn hide(&self, sys: &mut System) -> Plastic {
        let open = f64::INFINITY;
        let elastic = Laws::new(&Section {
            n_y: open,
            m_y: open,
            t_y: open,
            moment_cap: open,
            ..sys.model.section.clone()
        });
        Plastic {
            bend: std::mem::replace(&mut sys.state.rod.bend, self.bend.clone()),
            twist: std::mem::replace(&mut sys.state.rod.twist, self.twist.clone()),
            stretch: std::mem::replace(&mut sys.state.rod.stretch, self.stretch.clone()),
            laws: std::mem::replace(&mut sys.model.laws, elastic),
        }
    }

    /// Takes the missing stiffness off an elastic tangent.
    pub(crate) fn soften(&self, sys: &mut System, band: &mut Band) {
        for lack in &self.lacks {
            match *lack {
                Lack::Joint(i, bend, twist) => soften_joint(sys, band, i, &bend, twist),
                Lack::Edge(j, lack) => {
                    let d = sys.state.rod.x[j + 1] - sys.state.rod.x[j];
                    let t = d / d.norm();
                    for (p, a) in (0..6).map(|q| (q / 3, q % 3)) {
                        for (r, b) in (0..6).map(|q| (q / 3, q % 3)) {
                            let sign = if p == r { 1.0 } else { -1.0 };
                            *band.at(PER_NODE * (j + p) + a, PER_NODE * (j + r) + b) -=
                                sign * lack * t[a] * t[b] / sys.state.rod.rest[j];
                        }
                    }
                }
            }
        }
    }
}

impl Plastic {
    /// Puts state and laws back.
    pub(crate) fn restore(self, sys: &mut System) {
        sys.state.rod.bend = self.bend;
        sys.state.rod.twist = self.twist;
        sys.state.rod.stretch = self.stretch;
        sys.model.laws = self.laws;
    }
}

/// Elastic modulus minus the tangent of a yielding scalar law.
fn lack(law: &crate::rod::Law, state: &Scalar, strain: f64) -> f64 {
    let d = FINE * (strain - state.strain).abs();
    let (ahead, ..) = respond_scalar(law, state, strain + d);
    let (behind, ..) = respond_scalar(law, state, strain - d);
    law.modulus - (ahead - behind) / (2.0 * d)
}

/// Strains of joint `i`; none at an end that is not clamped.
fn strains(sys: &System, i: usize) -> Option<Strains> {
    let (rod, roll) = (&sys.state.rod, &sys.state.roll);
    let edge = |j: usize| -> Quat {
        let d = rod.x[j + 1] - rod.x[j];
        align(&rod.frame[j], &(d / d.norm()), roll[j])
    };
    let before = if i == 0 {
        sys.clamp_frame(0)?
    } else {
        edge(i - 1)
    };
    let after = if i == rod.edges() {
        sys.clamp_frame(1)?
    } else {
        edge(i)
    };
    let joint = Joint::between(&before, &after);
    let inv = 1.0 / rod.voronoi(i);
    Some([joint.bend[0] * inv, joint.bend[1] * inv, joint.twist * inv])
}

fn soften_joint(sys: &mut System, band: &mut Band, i: usize, bend: &[[f64; 2]; 2], twist: f64) {
    let (nodes, edges) = (sys.state.rod.nodes(), sys.state.rod.edges());
    let lv = sys.state.rod.voronoi(i);
    let mut rows: Vec<(usize, Strains)> = Vec::with_capacity(12);
    for k in i.saturating_sub(1)..(i + 2).min(nodes) {
        for a in 0..PER_NODE {
            if a == 3 && (k >= edges || k > i) {
                continue;
            }
            let rest = sys.state.rod.rest[k.min(edges - 1)];
            let width = 2.0 * NUDGE * rest;
            let mut sides = [[0.0; 3]; 2];
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                if a < 3 {
                    let before = sys.state.rod.x[k][a];
                    sys.state.rod.x[k][a] += sign * NUDGE * rest;
                    sides[side] = strains(sys, i).unwrap_or_default();
                    sys.state.rod.x[k][a] = before;
                } else {
                    let before = sys.state.roll[k];
                    sys.state.roll[k] += sign * NUDGE;
                    sides[side] = strains(sys, i).unwrap_or_default();
                    sys.state.roll[k] = before;
                }
            }
            let mut b = [0.0; 3];
            for c in 0..3 {
                b[c] = (sides[0][c] - sides[1][c]) / width;
            }
            rows.push((PER_NODE * k + a, b));
        }
    }
    for (r, br) in &rows {
        for (c, bc) in &rows {
            let bending: f64 = (0..4)
                .map(|q| br[q / 2] * bend[q / 2][q % 2] * bc[q % 2])
                .sum();
            *band.at(*r, *c) -= lv * (bending + br[2] * twist * bc[2]);
        }
    }
}
