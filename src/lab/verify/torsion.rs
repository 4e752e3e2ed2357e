//! Static twist and torsion modes of a straight wire.

use super::equilibrium::follow_with_twist;
use super::modes::{Motion, lowest};
use super::wire::{clamp_along_x, straight, twist};
use super::{Answer, Answers, Context, VerifyError};
use crate::math::V3;
use crate::system::Support;

/// Edges along the wire.
const EDGES: f64 = 200.0;

/// Frequencies with one and with both ends held, and the twist under a torque at the free end.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (length, torque) = (ctx.positive("L_m")?, ctx.number("torque_Nm")?);
    let n = ctx.edges(length, length / EDGES)?;
    let mut sys = straight(ctx.elastic(), &vec![length / n as f64; n]);
    sys.state.support[0] = clamp_along_x(V3::zeros());
    let mut answers = Answers::new();
    // rolls of a wind have no inertia, and so no frequency
    if !ctx.winds() {
        sys.evaluate(None);
        let one = lowest(ctx, &mut sys, Motion::Roll, 2)?;
        sys.state.support[1] = clamp_along_x(V3::x() * length);
        let both = lowest(ctx, &mut sys, Motion::Roll, 1)?;
        answers.push(("fixed_free_f1_Hz", Answer::Number(one[0])));
        answers.push(("fixed_free_f2_Hz", Answer::Number(one[1])));
        answers.push(("fixed_fixed_f1_Hz", Answer::Number(both[0])));
    }
    // a straight wire is meant, which much torque would make a helix: its end stays on the axis, and it is drawn by twice what keeps a
    // long wire straight
    let pull = 2.0 * torque * torque / (4.0 * sys.model.section.ei);
    sys.model.loads.nodal = vec![(n, V3::x() * pull)];
    sys.state.support[1] = Support {
        hold: [false, true, true],
        ..Support::pinned(V3::x() * length)
    };
    follow_with_twist(ctx, &mut sys, |sys, share| {
        sys.model.loads.moments = vec![(n - 1, V3::x() * (torque * share))];
    })?;
    let edges: f64 = (0..n)
        .map(|i| twist(&sys, i) * sys.state.rod.voronoi(i))
        .sum();
    // the end node lies half an edge beyond the middle of the last edge
    let total = edges + 0.5 * twist(&sys, n - 1) * sys.state.rod.rest[n - 1];
    answers.push(("static_twist_rad", Answer::Number(total)));
    Ok(answers)
}
