//! Bending frequencies of a straight wire under tension, for three ways to hold it.

use super::equilibrium::follow;
use super::modes::{Motion, lowest};
use super::wire::{heading, straight};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::rod::Twist;
use crate::system::{Support, System};

/// Edges over the wire's length, at least and at most.
const EDGES: [f64; 2] = [200.0, 400.0];

/// The three lowest frequencies.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let mut sys = stretched(ctx)?;
    let f = lowest(ctx, &mut sys, Motion::Along(1), 3)?;
    Ok(vec![
        ("f1_Hz", Answer::Number(f[0])),
        ("f2_Hz", Answer::Number(f[1])),
        ("f3_Hz", Answer::Number(f[2])),
    ])
}

/// The wire under its tension, held as the case says; the force at a free end keeps its direction.
fn stretched(ctx: &Context) -> Result<System, VerifyError> {
    let (length, tension) = (ctx.positive("L_m")?, ctx.number("T_N")?);
    let section = ctx.elastic();
    let (clamped, far) = match ctx.text("bc")? {
        "clamped-free" => (true, [false; 3]),
        "clamped-clamped" => (true, [false, true, true]),
        "pinned-pinned" => (false, [false, true, true]),
        other => {
            return Err(VerifyError::Input {
                name: "bc".to_owned(),
                problem: format!(
                    "{other}: clamped-free, clamped-clamped or pinned-pinned is wanted"
                ),
            });
        }
    };
    // the clamps bend the wire over this length
    let layer = (section.ei / tension.abs().max(f64::MIN_POSITIVE)).sqrt();
    let spacing = (length / EDGES[0]).min(layer / 5.0).max(length / EDGES[1]);
    let n = ctx.edges(length, spacing)?;
    // the length is meant under tension
    let rest = length / (1.0 + tension / section.ea);
    let mut sys = straight(section, &vec![rest / n as f64; n]);
    sys.model.twist = Twist::Off;
    let frame = |clamps: bool| clamps.then(|| heading(0.0));
    sys.state.support = [
        Support {
            frame: frame(clamped),
            ..Support::pinned(V3::zeros())
        },
        Support {
            hold: far,
            frame: frame(clamped && far[1]),
            ..Support::free()
        },
    ];
    follow(ctx, &mut sys, |sys, share| {
        sys.model.loads.nodal = vec![(n, V3::x() * (tension * share))];
    })?;
    Ok(sys)
}
