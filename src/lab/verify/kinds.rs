//! Every kind of case and the function that computes its answers.

use super::case::{Answers, Context, VerifyError};
use super::{
    axial_wave, bending_modes, bulge_linear, capstan, corner_edge, cyclic_bending,
    elastica_cantilever, end_couple, groove_seat, hanging_wire, helix, mandrel_springback,
    penalty_impact, shoulder_drop, shoulder_static, spinning_ring, square_loop, torsion,
    twist_buckling, winding_feed,
};

/// Computes the answers of one case.
pub type Solve = fn(&Context) -> Result<Answers, VerifyError>;

/// A kind of case.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// its name in case files
    pub name: &'static str,
    /// computes the answers of a case
    pub run: Solve,
    /// in what the implicit method's set-up differs from that of a wind; "wind" if in nothing
    pub setup: &'static str,
}

/// Contact law, stiffness, spacing, tolerance, twist and formula of time of the default scene, with elastic wire.
pub const WIND: &str = "wind";
/// Rest is found without steps in time.
const STATICS: &str = "at rest, found without steps in time; spacing of the kind";

const fn kind(name: &'static str, run: Solve, setup: &'static str) -> Kind {
    Kind { name, run, setup }
}

/// Every kind there is.
pub const KINDS: &[Kind] = &[
    kind("elastica_cantilever", elastica_cantilever::run, STATICS),
    kind("end_couple", end_couple::run, STATICS),
    kind(
        "bending_modes",
        bending_modes::run,
        "small oscillations without contact, midpoint rule",
    ),
    kind(
        "axial_wave",
        axial_wave::run,
        "waves without contact, midpoint rule",
    ),
    kind(
        "torsion",
        torsion::run,
        "small oscillations without contact, midpoint rule",
    ),
    kind("hanging_wire", hanging_wire::run, STATICS),
    kind("helix", helix::run, STATICS),
    kind("mandrel_springback", mandrel_springback::run, STATICS),
    kind("cyclic_bending", cyclic_bending::run, STATICS),
    kind("bulge_linear", bulge_linear::run, STATICS),
    kind("corner_edge", corner_edge::run, STATICS),
    kind("square_loop", square_loop::run, STATICS),
    kind(
        "capstan",
        capstan::run,
        "stiffness, spacing and tolerance from the bend: a depth of 1e-5 and an error of 1e-6 of its radius",
    ),
    kind("twist_buckling", twist_buckling::run, STATICS),
    kind("shoulder_static", shoulder_static::run, WIND),
    kind("groove_seat", groove_seat::run, WIND),
    kind("shoulder_drop", shoulder_drop::run, WIND),
    kind(
        "spinning_ring",
        spinning_ring::run,
        "64 edges a turn; stiffness 0.09 of an edge's; onset 0.01 of the depth; steps of 1/24 of a breath",
    ),
    kind(
        "penalty_impact",
        penalty_impact::run,
        "the paper's nodal contact, whose dashpot may pull; RK4",
    ),
    kind(
        "winding_feed",
        winding_feed::run,
        "string-like wire with drag and a constant pull, tolerance 5e-6 of the bend radius",
    ),
];
