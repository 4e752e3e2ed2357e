//! Rigidities and yield limits of the wire's round section.

use super::pieces::Pieces;
use std::f64::consts::PI;

/// Density of wire enamel, kg/m^3. Polyamide-imide has 1420 (data sheet of Torlon 4203), polyesters of enamels somewhat less.
pub const ENAMEL_DENSITY: f64 = 1400.0;

/// Elastic-plastic section with three uncoupled laws and isotropic hardening.
///
/// Above a yield limit the tangent falls from `e*` to `e*_p`; an infinite limit makes the law
/// elastic.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// outer diameter over the enamel, m: what touches, and what lies beside what
    pub diameter: f64,
    /// diameter of the metal, m; the outer one of bare wire
    pub bare_diameter: f64,
    /// density of the metal, kg/m^3
    pub density: f64,
    /// density of the enamel, kg/m^3; it has mass and no stiffness
    pub enamel_density: f64,
    /// elastic stretch rigidity, N
    pub ea: f64,
    /// tangent stretch rigidity above yield, N
    pub ea_p: f64,
    /// elastic bending rigidity, N m^2
    pub ei: f64,
    /// tangent bending rigidity above yield, N m^2; the mean one where `hardening` has pieces
    pub ei_p: f64,
    /// elastic torsional rigidity, N m^2
    pub gj: f64,
    /// tangent torsional rigidity above yield, N m^2; the mean one where `hardening` has pieces
    pub gj_p: f64,
    /// axial force at yield, N
    pub n_y: f64,
    /// bending moment at yield, N m
    pub m_y: f64,
    /// torque at yield, N m
    pub t_y: f64,
    /// largest bending moment the section carries, N m (infinite: no cap)
    pub moment_cap: f64,
    /// tension at which the wire breaks, N
    pub strength: f64,
    /// what bending and torsion follow beyond yield in place of their tangents
    pub hardening: Hardening,
}

/// Hardening in pieces, of the laws that have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hardening {
    /// moment, N m, over curvature, 1/m; its limit is `m_y`
    pub bend: Option<Pieces>,
    /// torque, N m, over twist, 1/m; its limit is `t_y`
    pub twist: Option<Pieces>,
}

impl Section {
    /// Outer radius, m.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Area of the metal, m^2.
    pub fn bare_area(&self) -> f64 {
        PI * self.bare_diameter * self.bare_diameter / 4.0
    }

    /// Young's modulus, Pa.
    pub fn modulus(&self) -> f64 {
        self.ea / (0.25 * PI * self.bare_diameter * self.bare_diameter)
    }

    /// Mass per length, kg/m: metal and enamel.
    pub fn mass_per_length(&self) -> f64 {
        self.metal_per_length() + self.enamel_per_length()
    }

    /// Polar moment of inertia per length about the wire axis, kg m: `1/2 rho A r^2` of the metal, and
    /// `1/2 rho A (R^2 + r^2)` of the ring of enamel.
    pub fn spin_inertia_per_length(&self) -> f64 {
        let (outer, bare) = (self.radius(), 0.5 * self.bare_diameter);
        0.5 * self.metal_per_length() * bare * bare
            + 0.5 * self.enamel_per_length() * (outer * outer + bare * bare)
    }

    fn metal_per_length(&self) -> f64 {
        self.density * PI * self.bare_diameter * self.bare_diameter / 4.0
    }

    /// 0 for bare wire.
    fn enamel_per_length(&self) -> f64 {
        let squares = self.diameter * self.diameter - self.bare_diameter * self.bare_diameter;
        self.enamel_density * PI * squares / 4.0
    }
}

#[cfg(test)]
impl Section {
    /// The paper's wire without its yield limits, for unit tests.
    pub(crate) fn table1_elastic() -> Self {
        let open = f64::INFINITY;
        Self {
            diameter: 0.7e-3,
            bare_diameter: 0.7e-3,
            density: 8960.0,
            enamel_density: ENAMEL_DENSITY,
            ea: 48900.0,
            ea_p: 1100.0,
            ei: 3.06e-3,
            ei_p: 1.13e-4,
            gj: 4.32e-3,
            gj_p: 9e-5,
            n_y: open,
            m_y: open,
            t_y: open,
            moment_cap: open,
            strength: open,
            hardening: Hardening::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enamel_adds_the_mass_of_its_ring_and_nothing_else() {
        let bare = Section::table1_elastic();
        let enamelled = Section {
            diameter: 0.8e-3,
            ..bare.clone()
        };
        let (outer, inner) = (0.4e-3_f64, 0.35e-3_f64);
        let ring = 1400.0 * PI * (outer.powi(2) - inner.powi(2));
        let more = enamelled.mass_per_length() - bare.mass_per_length();
        assert!((more / ring - 1.0).abs() < 1e-12, "{more} {ring}");
        // 1/2 pi rho (R^4 - r^4)
        let about = 0.5 * 1400.0 * PI * (outer.powi(4) - inner.powi(4));
        let more = enamelled.spin_inertia_per_length() - bare.spin_inertia_per_length();
        assert!((more / about - 1.0).abs() < 1e-12, "{more} {about}");
        assert_eq!(enamelled.bare_area(), bare.bare_area());
        assert_eq!(enamelled.radius(), outer);
    }
}
