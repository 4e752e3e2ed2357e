//! Lengths of wire that nodes stand for while the edge at the nozzle grows.

use crate::rod::Rod;

/// Length of wire that node `i` stands for when the edge at the nozzle has `grown`, m.
pub(super) fn voronoi(rod: &Rod, grown: f64, i: usize) -> f64 {
    let at_nozzle = i + 2 >= rod.nodes();
    rod.voronoi(i) + if at_nozzle { 0.5 * grown } else { 0.0 }
}

/// Share of node `i`'s set curvature and twist when the edge at the nozzle has `grown`, see `System::keep_set_at_nozzle`.
pub(super) fn set_share(rod: &Rod, grown: f64, i: usize) -> f64 {
    if i + 2 == rod.nodes() {
        rod.voronoi(i) / voronoi(rod, grown, i)
    } else {
        1.0
    }
}
