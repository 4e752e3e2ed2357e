//! The wire of the paper's Table 1.

use coilwind::rod::{Hardening, Section};

/// Elastic whatever its strain; limits are set by the test that needs them.
pub(crate) fn elastic() -> Section {
    let open = f64::INFINITY;
    Section {
        diameter: 0.7e-3,
        bare_diameter: 0.7e-3,
        enamel_density: 1400.0,
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
        hardening: Hardening::default(),
    }
}
