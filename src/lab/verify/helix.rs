//! A straight elastic wire held in a helix by an axial force and couple.
//!
//! The wire makes half a turn, or less where it is much twisted, so that the helix is stable. Its
//! ends are clamped in place, direction and roll as on the helix; the rest finds its equilibrium.
//! The wrench is what the clamp at the far end exerts on the wire.

use super::equilibrium::settle_with_twist;
use super::{Answer, Answers, Context, VerifyError};
use crate::math::{Quat, V3};
use crate::rod::Rod;
use crate::system::{Support, System};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::f64::consts::{PI, TAU};

/// Edges of a turn.
const EDGES: f64 = 300.0;

/// Turn that the wire makes about the axis at most, rad. A whole turn springs over into a helix of
/// the other hand.
const ARC: f64 = PI;

/// Error of the stretch, as a share of that of wire without any, at which it is found, and secants until then at most.
const STRETCHED: f64 = 1e-3;
const MOST_SECANTS: usize = 6;

/// Twisting torque times length over bending stiffness, at most. Straight clamped wire buckles at
/// 8.99.
const TWIST: f64 = PI;

/// The helix about +z.
struct Helix {
    radius: f64,
    pitch: f64,
    /// what the section turns against the normal, per length
    roll: f64,
}

impl Helix {
    /// Length of wire per angle.
    fn rate(&self) -> f64 {
        let rise = self.pitch / TAU;
        (self.radius * self.radius + rise * rise).sqrt()
    }

    fn point(&self, angle: f64) -> V3 {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        V3::new(self.radius * c, self.radius * s, self.pitch * angle / TAU)
    }

    /// Frame of the section: z along the wire, x the inward normal turned by the roll.
    fn frame(&self, angle: f64) -> Quat {
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let tangent = V3::new(-self.radius * s, self.radius * c, self.pitch / TAU) / self.rate();
        let normal = V3::new(-c, -s, 0.0);
        let turn = self.roll * self.rate() * angle;
        let (s, c) = (libm::sin(turn), libm::cos(turn));
        let binormal = tangent.cross(&normal);
        let x = normal * c + binormal * s;
        let axes = Matrix3::from_columns(&[x, tangent.cross(&x), tangent]);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)).into_inner()
    }
}

/// Force and couple along the axis.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (radius, pitch) = (ctx.positive("R_m")?, ctx.number("pitch_m")?);
    let density = ctx.number("twist_density_1_per_m")?;
    let mut helix = Helix {
        radius,
        pitch,
        roll: 0.0,
    };
    // the normal itself turns about the wire by the helix's torsion
    helix.roll = density - pitch / TAU / (helix.rate() * helix.rate());
    let section = ctx.elastic();
    let twisted = density.abs() * section.gj / section.ei * helix.rate();
    let arc = ARC.min(TWIST / twisted);
    let length = arc * helix.rate();
    // neither bend nor twist of a joint may come near half a turn
    let n = ctx.edges(
        length,
        length / (EDGES * arc / TAU).max(density.abs() * length / 0.1),
    )?;
    let points: Vec<V3> = (0..=n)
        .map(|i| helix.point(arc * i as f64 / n as f64))
        .collect();
    let chords: Vec<f64> = points.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
    let mut rod = Rod::through(&points, None);
    for j in 0..n {
        rod.frame[j] = helix.frame(arc * (j as f64 + 0.5) / n as f64);
    }
    rod.realign();
    let mut sys = System::new(section, rod);
    sys.state.support = [
        Support::clamped(points[0], helix.frame(0.0)),
        Support::clamped(points[n], helix.frame(arc)),
    ];
    stretch(ctx, &mut sys, &chords)?;
    let force = -sys.state.load.force[n];
    let couple = sys.state.load.clamp_moment[1] + points[n].cross(&force);
    Ok(vec![
        ("axial_force_N", Answer::Number(force.z)),
        ("axial_moment_Nm", Answer::Number(couple.z)),
    ])
}

/// Lets the wire settle with rest lengths such that its `chords`, m, are as long as its own pull makes them: between ends
/// that stand, wire that is a little too long pushes.
fn stretch(ctx: &Context, sys: &mut System, chords: &[f64]) -> Result<(), VerifyError> {
    let (ea, edges) = (sys.model.section.ea, chords.len());
    let mut off = |strain: f64| {
        for (rest, chord) in sys.state.rod.rest.iter_mut().zip(chords) {
            *rest = chord / (1.0 + strain);
        }
        sys.refresh();
        settle_with_twist(ctx, sys)?;
        let inner = &sys.state.load.tension[edges / 4..edges - edges / 4];
        let pull = inner.iter().sum::<f64>() / inner.len() as f64;
        Ok::<f64, VerifyError>(pull / ea - strain)
    };
    let mut last = (0.0, off(0.0)?);
    let (first, mut strain) = (last.1, last.1);
    for _ in 0..MOST_SECANTS {
        let now = off(strain)?;
        if now.abs() <= STRETCHED * first.abs() || now == last.1 {
            break;
        }
        let next = strain - now * (strain - last.0) / (now - last.1);
        (last, strain) = ((strain, now), next);
    }
    Ok(())
}
