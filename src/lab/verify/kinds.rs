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

/// Every kind there is.
pub const KINDS: &[(&str, Solve)] = &[
    ("elastica_cantilever", elastica_cantilever::run),
    ("end_couple", end_couple::run),
    ("bending_modes", bending_modes::run),
    ("axial_wave", axial_wave::run),
    ("torsion", torsion::run),
    ("hanging_wire", hanging_wire::run),
    ("helix", helix::run),
    ("mandrel_springback", mandrel_springback::run),
    ("cyclic_bending", cyclic_bending::run),
    ("bulge_linear", bulge_linear::run),
    ("corner_edge", corner_edge::run),
    ("square_loop", square_loop::run),
    ("capstan", capstan::run),
    ("twist_buckling", twist_buckling::run),
    ("shoulder_static", shoulder_static::run),
    ("groove_seat", groove_seat::run),
    ("shoulder_drop", shoulder_drop::run),
    ("spinning_ring", spinning_ring::run),
    ("penalty_impact", penalty_impact::run),
    ("winding_feed", winding_feed::run),
];
