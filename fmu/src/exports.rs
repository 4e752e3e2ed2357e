//! The C functions of FMI 2.0 for co-simulation, all of them.
//!
//! Each checks its pointers, enters the guard, calls safe code and maps the result to a status.
//! What this FMU does not support is exported all the same, since importers bind every symbol; it
//! returns `fmi2Error` with the reason, as `modelDescription.xml` announces.
//!
//! # Safety
//!
//! All functions rely on the promises of FMI 2.0.5: a component is NULL or came from
//! `fmi2Instantiate` and was not freed; calls on one component are not made at the same time;
//! arrays hold as many values as the call says; strings end with a NUL; callbacks stay callable
//! until `fmi2FreeInstance`. NULL is answered with an error wherever data is needed.
#![allow(clippy::missing_safety_doc)]

use crate::ffi::*;
use crate::guard;
use crate::instance::Instance;
use crate::lifecycle::Function;
use crate::pointers;
use crate::refusal::Refusal;

/// Refuses a function that needs a capability the FMU does not declare.
///
/// # Safety
///
/// As for [`guard::call`].
unsafe fn unsupported(
    c: fmi2Component,
    function: Function,
    capability: &'static str,
) -> fmi2Status {
    // SAFETY: passed on to the caller.
    unsafe { guard::call(c, function, |_| Err(Refusal::Unsupported { capability })) }
}

const NO_STATE: &str = "canGetAndSetFMUstate = false";
const NO_SERIAL: &str = "canSerializeFMUstate = false";

/// Name of the platform that the C types are for.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
    c"default".as_ptr()
}

/// Version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> fmi2String {
    c"2.0".as_ptr()
}

/// Switches categories of messages on or off; no categories stand for all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: the importer hands over `nCategories` strings.
    unsafe {
        guard::call(c, Function::SetDebugLogging, |instance| {
            let names = pointers::strings("categories", categories, nCategories)?;
            instance.set_debug_logging(loggingOn != 0, &names)
        })
    }
}

/// A new instance, or NULL and a message.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: fmi2Type,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: strings end with a NUL, callbacks stay callable until the instance is freed.
    unsafe {
        guard::instantiate(pointers::host(instanceName, functions), || {
            let name = pointers::string("instanceName", instanceName)?;
            let guid = pointers::string("fmuGUID", fmuGUID)?;
            let location = pointers::string("fmuResourceLocation", fmuResourceLocation).ok();
            Instance::new(&name, fmuType, &guid, location.as_deref(), loggingOn != 0)
        })
    }
}

/// Frees an instance; NULL is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: the importer does not use the component again.
    unsafe { guard::free(c) }
}

/// Start time, stop time if there is one; the tolerance is not used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    _toleranceDefined: fmi2Boolean,
    _tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(c, Function::SetupExperiment, |instance| {
            instance.setup_experiment(startTime, (stopTimeDefined != 0).then_some(stopTime))
        })
    }
}

/// From here on start values can be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(
            c,
            Function::EnterInitializationMode,
            Instance::enter_initialization_mode,
        )
    }
}

/// Builds the scene; from here on steps can be made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe {
        guard::call(
            c,
            Function::ExitInitializationMode,
            Instance::exit_initialization_mode,
        )
    }
}

/// Ends the run; values can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe { guard::call(c, Function::Terminate, Instance::terminate) }
}

/// Back to the state after `fmi2Instantiate`, also after an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe { guard::call(c, Function::Reset, Instance::reset) }
}

/// Values of Real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::GetReal, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice_mut("value", value, nvr)?,
            );
            value.copy_from_slice(&instance.get::<f64>(vr)?);
            Ok(())
        })
    }
}

/// Values of Integer variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::GetInteger, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice_mut("value", value, nvr)?,
            );
            value.copy_from_slice(&instance.get::<i32>(vr)?);
            Ok(())
        })
    }
}

/// Values of Boolean variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::GetBoolean, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice_mut("value", value, nvr)?,
            );
            let values = instance.get::<bool>(vr)?;
            value
                .iter_mut()
                .zip(values)
                .for_each(|(to, from)| *to = fmi2Boolean::from(from));
            Ok(())
        })
    }
}

/// Values of String variables; they live until the next call on this instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::GetString, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice_mut("value", value, nvr)?,
            );
            value.copy_from_slice(&instance.get_strings(vr)?);
            Ok(())
        })
    }
}

/// Sets Real inputs and parameters, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::SetReal, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice("value", value, nvr)?,
            );
            instance.set(vr, value.iter().copied())
        })
    }
}

/// Sets Integer parameters, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::SetInteger, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice("value", value, nvr)?,
            );
            instance.set(vr, value.iter().copied())
        })
    }
}

/// Sets Boolean parameters, all or none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Boolean,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values.
    unsafe {
        guard::call(c, Function::SetBoolean, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::slice("value", value, nvr)?,
            );
            instance.set(vr, value.iter().map(|value| *value != 0))
        })
    }
}

/// Sets String parameters, all or none; the strings are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2String,
) -> fmi2Status {
    // SAFETY: both arrays hold `nvr` values, the strings end with a NUL.
    unsafe {
        guard::call(c, Function::SetString, |instance| {
            let (vr, value) = (
                pointers::slice("vr", vr, nvr)?,
                pointers::strings("value", value, nvr)?,
            );
            instance.set(vr, value)
        })
    }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(
    c: fmi2Component,
    _FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::GetFMUstate, NO_STATE) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, _FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::SetFMUstate, NO_STATE) }
}

/// Fine for NULL and for a pointer to NULL, as the standard wants; there are no other states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or points to a state.
    unsafe {
        guard::call(c, Function::FreeFMUstate, |_| match FMUstate.as_ref() {
            Some(state) if !state.is_null() => Err(Refusal::Unsupported {
                capability: NO_STATE,
            }),
            _ => Ok(()),
        })
    }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    _FMUstate: fmi2FMUstate,
    _size: *mut usize,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::SerializedFMUstateSize, NO_SERIAL) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    _FMUstate: fmi2FMUstate,
    _serializedState: *mut fmi2Byte,
    _size: usize,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::SerializeFMUstate, NO_SERIAL) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    _serializedState: *const fmi2Byte,
    _size: usize,
    _FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::DeSerializeFMUstate, NO_SERIAL) }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    _vUnknown_ref: *const fmi2ValueReference,
    _nUnknown: usize,
    _vKnown_ref: *const fmi2ValueReference,
    _nKnown: usize,
    _dvKnown: *const fmi2Real,
    _dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    let capability = "providesDirectionalDerivative = false";
    // SAFETY: only the component is looked at.
    unsafe { unsupported(c, Function::GetDirectionalDerivative, capability) }
}

/// Not supported: inputs are held over a step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    _vr: *const fmi2ValueReference,
    _nvr: usize,
    _order: *const fmi2Integer,
    _value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe {
        unsupported(
            c,
            Function::SetRealInputDerivatives,
            "canInterpolateInputs = false",
        )
    }
}

/// Not supported.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    _vr: *const fmi2ValueReference,
    _nvr: usize,
    _order: *const fmi2Integer,
    _value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: only the component is looked at.
    unsafe {
        unsupported(
            c,
            Function::GetRealOutputDerivatives,
            "maxOutputDerivativeOrder = 0",
        )
    }
}

/// Computes one communication step; inputs are held over it.
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

/// Never allowed, since no step is in progress when a call returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    // SAFETY: only the component is a pointer.
    unsafe { unsupported(c, Function::CancelStep, "canRunAsynchronuously = false") }
}

/// Status of a pending step: there is none.
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

/// `fmi2LastSuccessfulTime`
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

/// No status is an integer.
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

/// `fmi2Terminated`
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

/// `fmi2PendingStatus`: no step is pending.
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
