//! The communication step and its statuses.

use crate::error::Error;
use crate::ffi::{
    fmi2Boolean, fmi2Component, fmi2Integer, fmi2Real, fmi2Status, fmi2StatusKind, fmi2String,
};
use crate::guard;
use crate::lifecycle::Function;
use crate::pointers;

/// `fmi2DoStep`: computes one communication step, times in s.
///
/// Inputs are held over the step or follow their derivatives. `fmi2Discard` says that the solver
/// gave up within the step; `fmi2LastSuccessfulTime` is then the time that it reached.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(c, Function::DoStep, |instance| {
            instance.do_step(currentCommunicationPoint, communicationStepSize)
        })
    }
}

/// `fmi2CancelStep`: never allowed, since no step is in progress when a call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(c, Function::CancelStep, |_| {
            let capability = "canRunAsynchronuously = false";
            Err(Error::Unsupported { capability })
        })
    }
}

/// `fmi2GetStatus`: always `fmi2Discard`, since no step is ever pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Status,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe {
        guard::call(c, Function::GetStatus, |instance| {
            instance.pending_status(s)
        })
    }
}

/// `fmi2GetRealStatus`: `fmi2LastSuccessfulTime` in s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or has room for the value.
    unsafe {
        guard::call(c, Function::GetRealStatus, |instance| {
            let value = pointers::target("value", value)?;
            *value = instance.real_status(s)?;
            Ok(())
        })
    }
}

/// `fmi2GetIntegerStatus`: always `fmi2Discard`, since no status of FMI 2.0 is an Integer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe {
        guard::call(c, Function::GetIntegerStatus, |instance| {
            instance.pending_status(s)
        })
    }
}

/// `fmi2GetBooleanStatus`: `fmi2Terminated`, which is true after a failed step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or has room for the value.
    unsafe {
        guard::call(c, Function::GetBooleanStatus, |instance| {
            let value = pointers::target("value", value)?;
            *value = fmi2Boolean::from(instance.boolean_status(s)?);
            Ok(())
        })
    }
}

/// `fmi2GetStringStatus`: always `fmi2Discard`, since no step is ever pending.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    c: fmi2Component,
    s: fmi2StatusKind,
    _value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe {
        guard::call(c, Function::GetStringStatus, |instance| {
            instance.pending_status(s)
        })
    }
}
