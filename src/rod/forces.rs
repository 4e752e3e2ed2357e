//! Internal forces of the rod: one pass along the wire.
//!
//! Energy per edge `1/2 EA e^2 l`, per joint `lv (W_bend(kappa) + W_twist(tau))` with curvature
//! and twist the joint angles over the Voronoi length. Forces are exact derivatives of it. A
//! joint moment M turns the edge after it and, oppositely, the edge before it. An edge of
//! length L and direction t passes the moment G on as the shear couple `G x t / L`.

use super::joint::Joint;
use super::plasticity::{Law, respond_bend, respond_scalar};
use super::section::Section;
use super::state::Rod;
use crate::math::{Quat, V3};
use crate::math::{align, rotate};
use serde::{Deserialize, Serialize};

/// The three laws of a section, ready for use in a loop.
#[derive(Clone, Copy, Debug)]
pub struct Laws {
    /// tension (N) over stretch
    pub stretch: Law,
    /// moment (N m) over curvature (1/m)
    pub bend: Law,
    /// torque (N m) over twist per length (1/m)
    pub twist: Law,
}

impl Laws {
    /// Laws of a section.
    pub fn new(s: &Section) -> Self {
        let open = f64::INFINITY;
        Self {
            stretch: Law::new(s.ea, s.ea_p, s.n_y, open),
            bend: match s.hardening.bend.filter(|_| s.m_y.is_finite()) {
                Some(pieces) => Law::in_pieces(s.ei, &pieces, s.moment_cap),
                None => Law::new(s.ei, s.ei_p, s.m_y, s.moment_cap),
            },
            twist: match s.hardening.twist.filter(|_| s.t_y.is_finite()) {
                Some(pieces) => Law::in_pieces(s.gj, &pieces, open),
                None => Law::new(s.gj, s.gj_p, s.t_y, open),
            },
        }
    }
}

/// Forces on a rod, lab frame, and energies of one evaluation.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Load {
    /// force per node, N
    pub force: Vec<V3>,
    /// torque about the edge per edge, N m
    pub torque: Vec<f64>,
    /// direction of each edge
    pub tangent: Vec<V3>,
    /// tension per edge, N
    pub tension: Vec<f64>,
    /// moment that the clamps at the two ends put into the wire, N m
    pub clamp_moment: [V3; 2],
    /// plastic work done in this evaluation (bend, twist, stretch), J, when committed
    pub plastic: [f64; 3],
    /// elastic energy of the rod, J
    pub stored: f64,
    /// plastic work beyond what forces and moments at both ends of the step account for, J, see
    /// `plasticity::beyond`, when committed at once
    #[serde(skip)]
    pub beyond: f64,
}

impl Load {
    /// Becomes a copy of another, in the room that this one has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        let Self {
            force,
            torque,
            tangent,
            tension,
            clamp_moment,
            plastic,
            stored,
            beyond,
        } = other;
        self.force.clone_from(force);
        self.torque.clone_from(torque);
        self.tangent.clone_from(tangent);
        self.tension.clone_from(tension);
        (self.clamp_moment, self.plastic) = (*clamp_moment, *plastic);
        (self.stored, self.beyond) = (*stored, *beyond);
    }

    /// Makes room for a rod; keeps its capacity.
    pub fn fit(&mut self, rod: &Rod) {
        self.force.clear();
        self.force.resize(rod.nodes(), V3::zeros());
        self.torque.resize(rod.edges(), 0.0);
        self.tangent.resize(rod.edges(), V3::zeros());
        self.tension.resize(rod.edges(), 0.0);
    }
}

/// What one evaluation does besides forces.
#[derive(Clone, Copy, Debug)]
pub struct ForceParts {
    /// take over frames and plastic state as the new state
    pub commit: bool,
    /// whether twist is carried
    pub twist: bool,
}

/// Adds the internal forces of `rod` into a fitted `load`.
///
/// `clamp` holds the frames that clamp the wire's direction at its two ends (lab frame). The
/// body z axis is the direction of the wire there. `roll` is the angle by which each edge has
/// turned about its axis since its frame was taken over, rad.
pub fn internal_forces(
    rod: &mut Rod,
    laws: &Laws,
    clamp: &[Option<Quat>; 2],
    roll: &[f64],
    parts: ForceParts,
    load: &mut Load,
) {
    let edges = rod.edges();
    load.plastic = [0.0; 3];
    load.stored = 0.0;
    load.clamp_moment = [V3::zeros(); 2];
    // frame and moment at the start joint of the edge in hand
    let mut before: Option<Quat> = clamp[0];
    let mut start_moment = V3::zeros();
    let mut inverse_length = 0.0;
    for j in 0..=edges {
        // the frame after joint j: the edge itself, or the clamp at the far end
        let mut tangent = V3::zeros();
        let mut length = 0.0;
        let after = if j < edges {
            let d = rod.x[j + 1] - rod.x[j];
            length = d.norm();
            tangent = d / length;
            let q = align(&rod.frame[j], &tangent, roll[j]);
            if parts.commit {
                rod.frame[j] = q;
            }
            Some(q)
        } else {
            clamp[1]
        };
        let mut moment = V3::zeros();
        if let (Some(p), Some(n)) = (&before, &after) {
            let joint = Joint::between(p, n);
            let lv = rod.voronoi(j);
            let inv = 1.0 / lv;
            let (m, bend, work) = respond_bend(
                &laws.bend,
                &rod.bend[j],
                [joint.bend[0] * inv, joint.bend[1] * inv],
            );
            load.stored += 0.5 * (m[0] * m[0] + m[1] * m[1]) / laws.bend.modulus * lv;
            let mut torque = 0.0;
            if parts.twist {
                let (t, twist, work) =
                    respond_scalar(&laws.twist, &rod.twist[j], joint.twist * inv);
                torque = t;
                load.stored += 0.5 * t * t / laws.twist.modulus * lv;
                if parts.commit && work > 0.0 {
                    rod.twist[j] = twist;
                    load.plastic[1] += work * lv;
                }
            }
            if parts.commit && work > 0.0 {
                rod.bend[j] = bend;
                load.plastic[0] += work * lv;
            }
            moment = rotate(p, &joint.moment(m, torque));
            if j == 0 {
                load.clamp_moment[0] = -moment;
            } else if j == edges {
                load.clamp_moment[1] = moment;
            }
        }
        if j > 0 {
            // edge j - 1 is complete: start joint, end joint, stretch
            let e = j - 1;
            let t = load.tangent[e];
            let gamma = start_moment - moment;
            load.torque[e] = if parts.twist { -gamma.dot(&t) } else { 0.0 };
            let f = t * load.tension[e] + gamma.cross(&t) * inverse_length;
            load.force[e] += f;
            load.force[j] -= f;
        }
        if j < edges {
            let (n, state, work) =
                respond_scalar(&laws.stretch, &rod.stretch[j], length / rod.rest[j] - 1.0);
            load.tension[j] = n;
            load.stored += 0.5 * n * n / laws.stretch.modulus * rod.rest[j];
            if parts.commit && work > 0.0 {
                rod.stretch[j] = state;
                load.plastic[2] += work * rod.rest[j];
            }
            load.tangent[j] = tangent;
            inverse_length = 1.0 / length;
        }
        before = after;
        start_moment = moment;
    }
}

/// Stored (elastic) energy of the rod, J: of bending, twist and stretch.
///
/// The end joints count where a clamp is given.
pub fn stored_energy(rod: &Rod, laws: &Laws, clamp: &[Option<Quat>; 2], twist: bool) -> [f64; 3] {
    let edges = rod.edges();
    let mut e = [0.0; 3];
    let mut before = clamp[0];
    for j in 0..=edges {
        let after = if j < edges {
            Some(rod.frame[j])
        } else {
            clamp[1]
        };
        if let (Some(p), Some(n)) = (&before, &after) {
            let (eb, et) = joint_energy(rod, laws, j, p, n, rod.voronoi(j));
            e[0] += eb;
            e[1] += if twist { et } else { 0.0 };
        }
        if j < edges {
            e[2] += stretch_energy(rod, laws, j);
        }
        before = after;
    }
    e
}

/// Stored energy of joint `j` between two frames over the length `lv`: bending, twist, J.
pub(crate) fn joint_energy(
    rod: &Rod,
    laws: &Laws,
    j: usize,
    p: &Quat,
    n: &Quat,
    lv: f64,
) -> (f64, f64) {
    let joint = Joint::between(p, n);
    let (m, _, _) = respond_bend(
        &laws.bend,
        &rod.bend[j],
        [joint.bend[0] / lv, joint.bend[1] / lv],
    );
    let (t, _, _) = respond_scalar(&laws.twist, &rod.twist[j], joint.twist / lv);
    (
        0.5 * (m[0] * m[0] + m[1] * m[1]) / laws.bend.modulus * lv,
        0.5 * t * t / laws.twist.modulus * lv,
    )
}

/// Stored energy of the stretched edge `j`, J.
pub(crate) fn stretch_energy(rod: &Rod, laws: &Laws, j: usize) -> f64 {
    let length = (rod.x[j + 1] - rod.x[j]).norm();
    let (n, _, _) = respond_scalar(&laws.stretch, &rod.stretch[j], length / rod.rest[j] - 1.0);
    0.5 * n * n / laws.stretch.modulus * rod.rest[j]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn section() -> Section {
        Section::table1_elastic()
    }

    fn wavy(amplitude: f64, seed: u64) -> Rod {
        // a deterministic scatter is enough here; proptest drives the seed
        let mut s = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut next = || {
            s ^= s << 13;
            s ^= s >> 7;
            s ^= s << 17;
            (s % 10_000) as f64 / 5_000.0 - 1.0
        };
        let points: Vec<V3> = (0..8)
            .map(|i| {
                V3::new(0.5e-3 * i as f64, 0.0, 0.0) + V3::new(next(), next(), next()) * amplitude
            })
            .collect();
        let rest = vec![0.5e-3; 7];
        let mut rod = Rod::through(&points, Some(rest));
        for j in 0..7 {
            rod.frame[j] = align(&rod.frame[j], &rod.tangent(j), 0.1 * next());
        }
        for i in 0..8 {
            rod.bend[i].curvature = [30.0 * next(), 30.0 * next()];
            rod.twist[i].strain = 5.0 * next();
        }
        rod
    }

    fn clamps() -> [Option<Quat>; 2] {
        let q = |t: V3| Some(frame_for(t));
        [q(V3::new(1.0, 0.1, -0.05)), q(V3::new(1.0, -0.1, 0.2))]
    }

    fn frame_for(t: V3) -> Quat {
        crate::math::frame_along(&t.normalize(), None)
    }

    /// Energy after moving node `i` by `d`, frames carried along by parallel transport.
    fn energy_moved(rod: &Rod, laws: &Laws, clamp: &[Option<Quat>; 2], i: usize, d: V3) -> f64 {
        let mut r = rod.clone();
        r.x[i] += d;
        r.realign();
        stored_energy(&r, laws, clamp, true).iter().sum()
    }

    fn check_forces(mut rod: Rod) -> f64 {
        let s = section();
        let laws = Laws::new(&s);
        let clamp = clamps();
        let mut load = Load::default();
        load.fit(&rod);
        let roll = vec![0.0; rod.edges()];
        internal_forces(
            &mut rod,
            &laws,
            &clamp,
            &roll,
            ForceParts {
                commit: true,
                twist: true,
            },
            &mut load,
        );
        let scale = load.force.iter().map(|f| f.norm()).fold(1.0, f64::max);
        let h = 1e-10;
        let mut worst = 0.0_f64;
        for i in 0..rod.nodes() {
            for axis in [V3::x(), V3::y(), V3::z()] {
                let de = energy_moved(&rod, &laws, &clamp, i, axis * h)
                    - energy_moved(&rod, &laws, &clamp, i, axis * -h);
                worst = worst.max((de / (2.0 * h) + load.force[i].dot(&axis)).abs() / scale);
            }
        }
        for j in 0..rod.edges() {
            let h = 1e-6;
            let roll_energy = |a: f64| {
                let mut r = rod.clone();
                r.frame[j] = align(&r.frame[j], &r.tangent(j), a);
                stored_energy(&r, &laws, &clamp, true).iter().sum::<f64>()
            };
            let de = roll_energy(h) - roll_energy(-h);
            worst =
                worst.max((de / (2.0 * h) + load.torque[j]).abs() / (1.0 + load.torque[j].abs()));
        }
        worst
    }

    proptest! {
        #[test]
        fn forces_are_minus_the_energy_gradient(seed in 1u64..1_000_000, amplitude in 1e-6..1.2e-4f64) {
            let worst = check_forces(wavy(amplitude, seed));
            prop_assert!(worst < 3e-5, "relative difference {worst}");
        }

        #[test]
        fn no_net_force_and_no_net_moment(seed in 1u64..1_000_000) {
            let mut rod = wavy(1e-4, seed);
            let laws = Laws::new(&section());
            let mut load = Load::default();
            load.fit(&rod);
            let roll = vec![0.0; rod.edges()];
            internal_forces(&mut rod, &laws, &[None, None], &roll, ForceParts { commit: false, twist: true }, &mut load);
            let f: V3 = load.force.iter().sum();
            let m: V3 = (0..rod.nodes()).map(|i| rod.x[i].cross(&load.force[i])).sum::<V3>()
                + (0..rod.edges()).map(|j| load.tangent[j] * load.torque[j]).sum::<V3>();
            let scale = load.force.iter().map(|f| f.norm()).sum::<f64>();
            prop_assert!(f.norm() < 1e-12 * scale && m.norm() < 1e-12 * scale * 4e-3);
        }
    }

    #[test]
    fn degenerate_shapes() {
        // exactly straight, and folded by 170 degrees
        let straight: Vec<V3> = (0..8)
            .map(|i| V3::new(0.5e-3 * i as f64, 0.0, 0.0))
            .collect();
        assert!(check_forces(Rod::through(&straight, None)) < 3e-5);
        let a = 170f64.to_radians();
        let mut p: Vec<V3> = (0..4)
            .map(|i| V3::new(0.5e-3 * i as f64, 0.0, 0.0))
            .collect();
        for i in 1..5 {
            p.push(p[3] + V3::new(a.cos(), a.sin(), 0.0) * (0.5e-3 * i as f64));
        }
        assert!(check_forces(Rod::through(&p, None)) < 3e-5);
    }
}
