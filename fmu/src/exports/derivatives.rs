//! Derivatives by time and by inputs.

use crate::ffi::{fmi2Component, fmi2Integer, fmi2Real, fmi2Status, fmi2ValueReference};
use crate::guard;
use crate::lifecycle::Function;
use crate::pointers;
use libc::size_t;

/// `fmi2GetDirectionalDerivative`: the change of outputs that a change of inputs makes over the
/// last communication step, in the units of the variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    vUnknown_ref: *const fmi2ValueReference,
    nUnknown: size_t,
    vKnown_ref: *const fmi2ValueReference,
    nKnown: size_t,
    dvKnown: *const fmi2Real,
    dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the arrays of unknowns hold `nUnknown` values, those of knowns `nKnown`.
    unsafe {
        guard::call(c, Function::GetDirectionalDerivative, |instance| {
            let (unknown, known, change, value) = (
                pointers::slice("vUnknown_ref", vUnknown_ref, nUnknown)?,
                pointers::slice("vKnown_ref", vKnown_ref, nKnown)?,
                pointers::slice("dvKnown", dvKnown, nKnown)?,
                pointers::slice_mut("dvUnknown", dvUnknown, nUnknown)?,
            );
            value.copy_from_slice(&instance.directional_derivative(unknown, known, change)?);
            Ok(())
        })
    }
}

/// `fmi2SetRealInputDerivatives`: sets first derivatives of inputs by time, in the unit of the
/// input per s. They count from the start of the next step and hold for that step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    order: *const fmi2Integer,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: all three arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::SetRealInputDerivatives, |instance| {
            let (vr, order, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice("order", order, nvr)?,
                pointers::slice("value", value, nvr)?,
            );
            instance.set_input_derivatives(vr, order, value)
        })
    }
}

/// `fmi2GetRealOutputDerivatives`: first derivatives of outputs by time at the last communication
/// point, in the unit of the output per s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: size_t,
    order: *const fmi2Integer,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: all three arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::GetRealOutputDerivatives, |instance| {
            let (vr, order, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice("order", order, nvr)?,
                pointers::slice_mut("value", value, nvr)?,
            );
            value.copy_from_slice(&instance.output_derivatives(vr, order)?);
            Ok(())
        })
    }
}
