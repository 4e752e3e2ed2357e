//! Rigidities and yield limits of the wire's round section.

/// Elastic-plastic section with three uncoupled bilinear laws and isotropic hardening.
///
/// Above a yield limit the tangent falls from `e*` to `e*_p`; an infinite limit makes the law
/// elastic.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// diameter, m
    pub diameter: f64,
    /// density, kg/m^3
    pub density: f64,
    /// elastic stretch rigidity, N
    pub ea: f64,
    /// tangent stretch rigidity above yield, N
    pub ea_p: f64,
    /// elastic bending rigidity, N m^2
    pub ei: f64,
    /// tangent bending rigidity above yield, N m^2
    pub ei_p: f64,
    /// elastic torsional rigidity, N m^2
    pub gj: f64,
    /// tangent torsional rigidity above yield, N m^2
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
}

impl Section {
    /// Radius, m.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Mass per length, kg/m.
    pub fn mass_per_length(&self) -> f64 {
        self.density * std::f64::consts::PI * self.diameter * self.diameter / 4.0
    }

    /// Polar moment of inertia per length about the wire axis, `1/2 rho A r^2`, kg m.
    pub fn spin_inertia_per_length(&self) -> f64 {
        0.5 * self.mass_per_length() * self.radius() * self.radius()
    }
}

#[cfg(test)]
impl Section {
    /// The paper's wire without its yield limits, for unit tests.
    pub(crate) fn table1_elastic() -> Self {
        let open = f64::INFINITY;
        Self {
            diameter: 0.7e-3,
            density: 8960.0,
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
        }
    }
}
