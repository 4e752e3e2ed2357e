//! All work with pointers of the importer. Nothing here keeps one.

use crate::ffi::{fmi2CallbackFunctions, fmi2Component, fmi2FMUstate, fmi2String};
use crate::instance::Instance;
use crate::logger::Host;
use crate::refusal::Refusal;
use crate::state::Snapshot;
use std::ffi::CStr;

/// What an `fmi2Component` points to.
pub(crate) struct Component {
    pub(crate) instance: Instance,
    pub(crate) host: Host,
}

/// What an `fmi2FMUstate` points to.
pub(crate) struct Saved {
    pub(crate) snapshot: Snapshot,
    /// from the question for their number to the copying, so that they are made once
    pub(crate) bytes: Option<Vec<u8>>,
}

impl From<Snapshot> for Saved {
    fn from(snapshot: Snapshot) -> Self {
        Self {
            snapshot,
            bytes: None,
        }
    }
}

/// Hands an instance over to the importer; [`take`] is the way back.
pub(crate) fn give(component: Component) -> fmi2Component {
    Box::into_raw(Box::new(component)).cast()
}

/// The instance behind a handle; `None` for NULL.
///
/// # Safety
///
/// `c` is NULL or came from [`give`] and was not taken back, and the importer makes no second
/// call on it while the borrow lives (FMI 2.0.5, section 2.1.5: calls on one instance are made one
/// after the other).
pub(crate) unsafe fn component<'a>(c: fmi2Component) -> Option<&'a mut Component> {
    // SAFETY: a pointer from `give` is aligned, initialised and, by the contract above, unshared.
    unsafe { c.cast::<Component>().as_mut() }
}

/// Takes an instance back; `None` for NULL.
///
/// # Safety
///
/// As for [`component`], and the handle is not used again.
pub(crate) unsafe fn take(c: fmi2Component) -> Option<Box<Component>> {
    // SAFETY: a pointer from `give` came from `Box::into_raw` of this type.
    (!c.is_null()).then(|| unsafe { Box::from_raw(c.cast()) })
}

/// Hands a saved state over to the importer; [`take_state`] is the way back.
pub(crate) fn give_state(state: Saved) -> fmi2FMUstate {
    Box::into_raw(Box::new(state)).cast()
}

/// A saved state behind the importer's handle; `None` for NULL.
///
/// # Safety
///
/// `state` is NULL or came from [`give_state`], was not taken back, and is used by one call at a time.
pub(crate) unsafe fn state<'a>(state: fmi2FMUstate) -> Option<&'a mut Saved> {
    // SAFETY: a pointer from `give_state` is aligned, initialised and, by the contract above, unshared.
    unsafe { state.cast::<Saved>().as_mut() }
}

/// Takes a saved state back; `None` for NULL.
///
/// # Safety
///
/// As for [`state()`], and the handle is not used again.
pub(crate) unsafe fn take_state(state: fmi2FMUstate) -> Option<Box<Saved>> {
    // SAFETY: a pointer from `give_state` came from `Box::into_raw` of this type.
    (!state.is_null()).then(|| unsafe { Box::from_raw(state.cast()) })
}

/// Puts a state where the importer wants it: over the one that is there, or in a new place.
///
/// # Safety
///
/// As for [`state()`] where `*target` is not NULL.
pub(crate) unsafe fn put_state(target: &mut fmi2FMUstate, saved: Saved) {
    // SAFETY: passed on to the caller.
    match unsafe { state(*target) } {
        Some(there) => *there = saved,
        None => *target = give_state(saved),
    }
}

/// `n` values of the importer; with `n = 0` the pointer is not looked at.
///
/// # Safety
///
/// `data` is NULL or points to `n` initialised values that nobody writes while the borrow lives.
pub(crate) unsafe fn slice<'a, T>(
    argument: &'static str,
    data: *const T,
    n: usize,
) -> Result<&'a [T], Refusal> {
    match (n, data.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(Refusal::Null { argument }),
        // SAFETY: not NULL, and by the contract good for `n` values.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts(data, n) }),
    }
}

/// Room for `n` values; with `n = 0` the pointer is not looked at.
///
/// # Safety
///
/// `data` is NULL or points to `n` values that nobody else touches while the borrow lives.
pub(crate) unsafe fn slice_mut<'a, T>(
    argument: &'static str,
    data: *mut T,
    n: usize,
) -> Result<&'a mut [T], Refusal> {
    match (n, data.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(Refusal::Null { argument }),
        // SAFETY: not NULL, and by the contract good for `n` values and unshared.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts_mut(data, n) }),
    }
}

/// Room for one value.
///
/// # Safety
///
/// As for [`slice_mut`] with `n = 1`.
pub(crate) unsafe fn target<'a, T>(
    argument: &'static str,
    data: *mut T,
) -> Result<&'a mut T, Refusal> {
    // SAFETY: passed on to the caller.
    unsafe { data.as_mut() }.ok_or(Refusal::Null { argument })
}

/// A copy of a string.
///
/// # Safety
///
/// `text` is NULL or ends with a NUL.
pub(crate) unsafe fn string(argument: &'static str, text: fmi2String) -> Result<String, Refusal> {
    if text.is_null() {
        return Err(Refusal::Null { argument });
    }
    // SAFETY: not NULL, and by the contract NUL-terminated.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str()
        .map(str::to_owned)
        .map_err(|_| Refusal::Encoding { argument })
}

/// Copies of `n` strings.
///
/// # Safety
///
/// As for [`slice()`], and each element as for [`string`].
pub(crate) unsafe fn strings(
    argument: &'static str,
    data: *const fmi2String,
    n: usize,
) -> Result<Vec<String>, Refusal> {
    // SAFETY: passed on to the caller.
    let texts = unsafe { slice(argument, data, n) }?;
    // SAFETY: passed on to the caller.
    texts
        .iter()
        .map(|text| unsafe { string(argument, *text) })
        .collect()
}

/// The importer's side of a new instance; a name that cannot be read is replaced.
///
/// # Safety
///
/// `name` as for [`string`]; `functions` is NULL or points to callbacks that stay callable until
/// the instance is freed.
pub(crate) unsafe fn host(name: fmi2String, functions: *const fmi2CallbackFunctions) -> Host {
    // SAFETY: passed on to the caller.
    let name = unsafe { string("instanceName", name) };
    // SAFETY: passed on to the caller; members are copied, the struct is not kept.
    unsafe { Host::new(name.as_deref().unwrap_or("CoilWinding"), functions.as_ref()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ptr::{null, null_mut};

    #[test]
    fn nothing_may_be_null_something_may_not() {
        // SAFETY: NULL is allowed everywhere here, the rest are live locals.
        unsafe {
            assert!(slice::<f64>("vr", null(), 0).is_ok_and(<[f64]>::is_empty));
            assert!(matches!(
                slice::<f64>("vr", null(), 1),
                Err(Refusal::Null { argument: "vr" })
            ));
            assert!(slice_mut::<f64>("value", null_mut(), 0).is_ok_and(|s| s.is_empty()));
            assert!(slice_mut::<f64>("value", null_mut(), 2).is_err());
            assert!(target::<f64>("value", null_mut()).is_err());
            assert!(component(null_mut()).is_none());
            assert!(take(null_mut()).is_none());
            let numbers = [1.0, 2.0];
            assert_eq!(slice("vr", numbers.as_ptr(), 2).expect("two"), [1.0, 2.0]);
        }
    }

    #[test]
    fn strings_are_copied_and_checked() {
        let bad = [b'a' as i8, -1_i8, 0].map(|byte| byte as libc::c_char);
        let good = c"Wicklung \xc3\xbc";
        let list = [good.as_ptr(), c"".as_ptr()];
        // SAFETY: all of them end with a NUL or are NULL.
        unsafe {
            assert_eq!(string("s", good.as_ptr()).expect("UTF-8"), "Wicklung ü");
            assert!(matches!(
                string("s", bad.as_ptr()),
                Err(Refusal::Encoding { argument: "s" })
            ));
            assert!(matches!(
                string("s", null()),
                Err(Refusal::Null { argument: "s" })
            ));
            assert_eq!(
                strings("s", list.as_ptr(), 2).expect("two"),
                ["Wicklung ü", ""]
            );
            assert_eq!(strings("s", null(), 0).expect("none"), Vec::<String>::new());
            assert!(strings("s", [null()].as_ptr(), 1).is_err());
        }
    }
}
