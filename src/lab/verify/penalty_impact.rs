//! A node meeting the contact spring and dashpot: how long, how deep, how fast it leaves.
//!
//! Two nodes of the given mass, joined by an edge that stays unstressed, fly on a box's flat top.
//! The law is per length of wire, so its stiffness is the given one over the length of a node.
//!
//! It is the paper's law, whose dashpot may pull, in the paper's steps, whatever the preset; the checks
//! count for that preset only. The smooth contact of the production method never pulls.

use super::bench::{box_mesh, law};
use super::{Answer, Answers, Context, VerifyError};
use crate::contact::NodalModel;
use crate::integrate::{Explicit, ExplicitMethod};
use crate::math::V3;
use crate::rod::Rod;
use crate::system::System;
use std::sync::Arc;

/// Steps in `sqrt(m / k)`; a contact takes pi or more of these times.
const STEPS: f64 = 200.0;

/// Runs a case.
pub fn run(ctx: &Context) -> Result<Answers, VerifyError> {
    let (mass, stiffness) = (ctx.positive("mass_kg")?, ctx.positive("k_N_per_m")?);
    let (speed, damping_ratio) = (ctx.number("v_m_per_s")?, ctx.number("damping_ratio")?);
    let section = ctx.elastic();
    let r = section.radius();
    let length = mass / section.mass_per_length();
    let side = 4.0 * length + 10.0 * r;
    let half = 0.5 * side;
    let unit = (mass / stiffness).sqrt();
    let dt = unit / STEPS;
    // the surfaces meet in the middle of the first step
    let gap = 0.5 * speed * dt;
    let at = |x: f64| V3::new(x, 0.0, half + r + gap);
    let points = [at(-length), at(length)];
    let mut sys = System::new(section.clone(), Rod::through(&points, None));
    sys.state.rod.v = vec![V3::new(0.0, 0.0, -speed); 2];
    let law = law(stiffness / length, damping_ratio, 0.0);
    let floor = Arc::new(box_mesh(side, side, side)?);
    sys.touch_at_nodes(NodalModel {
        surface: floor,
        law,
        radius: r,
        diameter: section.diameter,
    });
    sys.evaluate(Some(0.0));
    let depth = |s: &System| half + r - s.state.rod.x[0].z;
    let mut deepest: f64 = 0.0;
    let mut entered = None;
    let mut rk4 = Explicit::new(ExplicitMethod::Rk4);
    for _ in 0..(40.0 * STEPS) as usize {
        let before = (depth(&sys), sys.state.rod.v[0].z);
        rk4.step(&mut sys, dt);
        let after = depth(&sys);
        // the surface is crossed evenly within a step
        let crossed = sys.state.time - dt * after / (after - before.0);
        if before.0 <= 0.0 && after > 0.0 {
            entered = Some(crossed);
        }
        deepest = deepest.max(after);
        if before.0 > 0.0 && after <= 0.0 {
            let Some(entered) = entered else { break };
            let share = before.0 / (before.0 - after);
            let leaving = before.1 + share * (sys.state.rod.v[0].z - before.1);
            return Ok(vec![
                ("contact_time_s", Answer::Number(crossed - entered)),
                ("restitution", Answer::Number(leaving / speed)),
                ("peak_penetration_m", Answer::Number(deepest)),
            ]);
        }
    }
    Err(VerifyError::NoAnswer(
        "the node never left the surface".to_owned(),
    ))
}
