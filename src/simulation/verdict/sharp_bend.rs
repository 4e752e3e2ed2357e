//! Wire that is bent more sharply than winding wire is tested for.

use crate::measure::OnTurn;
use crate::simulation::Winding;

/// Diameter of metal, m, up to which winding wire is tested round a rod, and the least diameter of the rod, m: it is the wire's
/// own where that is more. Thicker wire is drawn out by [`DRAWN`] instead. So IEC 60317 has it for enamelled round copper, by the
/// tests of IEC 60851-3; that fine wire is drawn out a little before is left out here.
const ROUND_A_ROD: f64 = 1.6e-3;
const LEAST_ROD: f64 = 0.15e-3;
const DRAWN: f64 = 0.32;

/// Strain of the outside up to which a test shows that wire of this diameter, m, has no cracks.
fn tested(diameter: f64) -> f64 {
    if diameter > ROUND_A_ROD {
        return DRAWN;
    }
    diameter / (diameter + diameter.max(LEAST_ROD))
}

/// Plastic strain at the outside of wire with this plastic stretch and curvature, 1/m, whose metal has this diameter, m.
pub(in crate::simulation) fn strain_outside(stretch: f64, curvature: f64, diameter: f64) -> f64 {
    stretch.abs() + 0.5 * diameter * curvature
}

impl Winding {
    /// Where settled wire is bent most, in words, if no test of winding wire shows that it has no cracks there.
    pub(super) fn sharply_bent(&self) -> Option<String> {
        let frozen = &self.sys.state.frozen;
        let diameter = self.scene.wire.bare_diameter;
        let tested = tested(diameter);
        // what is told shows that it is more
        let mut sharpest = (tested + 0.005, None);
        for (i, arc) in frozen.arc.iter().enumerate() {
            let strain = strain_outside(frozen.plastic_strain[i], frozen.plastic_bend[i], diameter);
            if strain > sharpest.0
                && let Some(angle) = self.coil.judged_angle(*arc)
            {
                sharpest = (strain, Some(angle));
            }
        }
        let (strain, angle) = (sharpest.0, sharpest.1?);
        Some(format!(
            "Not judged: whether metal or enamel cracks where wire is bent to {:.0} % of strain on its outside, in {}; winding wire is tested to {:.0} %",
            1e2 * strain,
            OnTurn::at(angle),
            1e2 * tested
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::{strain_outside, tested};

    /// A rod of the wire's own diameter stretches the outside of the wire by a half.
    #[test]
    fn the_test_round_a_rod_is_at_its_limit() {
        for diameter in [0.15e-3, 0.7e-3, 1.6e-3] {
            let strain = strain_outside(0.0, 1.0 / diameter, diameter);
            assert!(
                (strain - tested(diameter)).abs() < 1e-12,
                "{diameter}: {strain}"
            );
        }
        assert_eq!(tested(1.7e-3), 0.32);
        assert!((tested(0.05e-3) - 0.25).abs() < 1e-12);
    }
}
