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
use libc::size_t;

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

/// The state that the importer means.
///
/// # Safety
///
/// As for [`pointers::state`].
unsafe fn saved<'a>(state: fmi2FMUstate) -> Result<&'a mut pointers::Saved, Refusal> {
    let argument = "FMUstate";
    // SAFETY: passed on to the caller.
    unsafe { pointers::state(state) }.ok_or(Refusal::Null { argument })
}

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
    nCategories: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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
    nvr: size_t,
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

/// A copy of everything that decides how the instance goes on; over the state that is there, if one is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or points to NULL or a state.
    unsafe {
        guard::call(c, Function::GetFMUstate, |instance| {
            let target = pointers::target("FMUstate", FMUstate)?;
            pointers::put_state(target, instance.snapshot().into());
            Ok(())
        })
    }
}

/// Back to a saved state, from whatever state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, FMUstate: fmi2FMUstate) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library.
    unsafe {
        guard::call(c, Function::SetFMUstate, |instance| {
            instance.restore(&saved(FMUstate)?.snapshot);
            Ok(())
        })
    }
}

/// Frees a state and sets the importer's pointer to NULL; NULL and a pointer to NULL are fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(
    c: fmi2Component,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's pointer is NULL or points to NULL or a state, which nobody uses again.
    unsafe {
        guard::call(c, Function::FreeFMUstate, |_| {
            if let Some(state) = FMUstate.as_mut() {
                drop(pointers::take_state(std::mem::replace(
                    state,
                    std::ptr::null_mut(),
                )));
            }
            Ok(())
        })
    }
}

/// How many bytes a state takes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    size: *mut size_t,
) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library, its pointer NULL or with room.
    unsafe {
        guard::call(c, Function::SerializedFMUstateSize, |instance| {
            let (saved, size) = (saved(FMUstate)?, pointers::target("size", size)?);
            let bytes = instance.bytes_of(&saved.snapshot)?;
            *size = bytes.len();
            saved.bytes = Some(bytes);
            Ok(())
        })
    }
}

/// The bytes of a state; a longer buffer is filled with zeros.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    FMUstate: fmi2FMUstate,
    serializedState: *mut fmi2Byte,
    size: size_t,
) -> fmi2Status {
    // SAFETY: the importer's state is NULL or one of this library, its array holds `size` bytes.
    unsafe {
        guard::call(c, Function::SerializeFMUstate, |instance| {
            let saved = saved(FMUstate)?;
            let bytes = match saved.bytes.take() {
                Some(bytes) => bytes,
                None => instance.bytes_of(&saved.snapshot)?,
            };
            let needed = bytes.len();
            if size < needed {
                return Err(Refusal::Buffer { size, needed });
            }
            let buffer = pointers::slice_mut("serializedState", serializedState.cast(), size)?;
            buffer[..needed].copy_from_slice(&bytes);
            buffer[needed..].fill(0);
            Ok(())
        })
    }
}

/// A state from bytes that an instance of this FMU wrote, perhaps elsewhere and long ago.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    serializedState: *const fmi2Byte,
    size: size_t,
    FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: the importer's array holds `size` bytes, its pointer is NULL or points to NULL or a state.
    unsafe {
        guard::call(c, Function::DeSerializeFMUstate, |instance| {
            let target = pointers::target("FMUstate", FMUstate)?;
            let bytes = pointers::slice("serializedState", serializedState.cast(), size)?;
            pointers::put_state(target, instance.snapshot_from(bytes)?.into());
            Ok(())
        })
    }
}

/// What a change of the inputs makes of the outputs a step of the solver later.
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

/// First derivatives of inputs, from the beginning of the next step on and for that step.
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

/// First derivatives of outputs at the last communication point.
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

/// Computes one communication step; inputs are held over it or follow their derivatives.
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
