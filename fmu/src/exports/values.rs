//! Values of variables, read and set by value reference.

use crate::ffi::{
    fmi2Boolean, fmi2Component, fmi2Integer, fmi2Real, fmi2Status, fmi2String, fmi2ValueReference,
};
use crate::guard;
use crate::lifecycle::Function;
use crate::pointers;
use libc::size_t;

/// `fmi2GetReal`: reads Real variables in their SI units.
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

/// `fmi2GetInteger`: reads Integer variables.
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

/// `fmi2GetBoolean`: reads Boolean variables, 0 or 1.
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

/// `fmi2GetString`: reads String variables. The strings live until the next call on the instance.
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

/// `fmi2SetReal`: sets Real inputs and parameters in their SI units, all of them or none.
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

/// `fmi2SetInteger`: sets Integer parameters, all of them or none.
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

/// `fmi2SetBoolean`: sets Boolean parameters, all of them or none.
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

/// `fmi2SetString`: sets String parameters, all of them or none. The strings are copied.
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
