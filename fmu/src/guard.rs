//! The frame round every exported call: checks that the call is allowed, rounds as the solver needs it,
//! catches panics and delivers messages.

use crate::error::Error;
use crate::ffi::{Status, fmi2Component, fmi2Status};
use crate::float_control::HostRounding;
use crate::instance::Instance;
use crate::lifecycle::Function;
use crate::logger::Host;
use crate::message::Message;
use crate::pointers;
use crate::pointers::Component;
use coilwind_model_description::Category;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `body` on the instance behind `c` if its state allows `function`, and returns the status.
///
/// Messages are delivered when the borrow of the instance has ended. NULL gives `fmi2Error`
/// without a message, since there is no logger to tell.
///
/// # Safety
///
/// As for [`pointers::component`].
pub(crate) unsafe fn call(
    c: fmi2Component,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Error>,
) -> fmi2Status {
    // SAFETY: passed on to the caller.
    let Some(component) = (unsafe { pointers::component(c) }) else {
        return Status::Error.code();
    };
    let (status, messages) = run(&mut component.instance, function, body);
    let host = component.host.clone();
    host.deliver(&messages);
    status.code()
}

/// Makes an instance and gives it to the importer. Where that fails, logs the reason and returns
/// NULL.
pub(crate) fn instantiate(
    host: Host,
    body: impl FnOnce() -> Result<Instance, Error>,
) -> fmi2Component {
    let name = "fmi2Instantiate";
    let made = {
        let _host = HostRounding::set_aside();
        catch_unwind(AssertUnwindSafe(body))
    };
    let message = match made {
        Ok(Ok(instance)) => return pointers::give(Component { instance, host }),
        Ok(Err(error)) => message_of(name, &error),
        Err(panic) => message_of_panic(name, panic),
    };
    host.deliver(&[message]);
    std::ptr::null_mut()
}

/// Frees an instance in any state. NULL is allowed.
///
/// # Safety
///
/// As for [`pointers::take`].
pub(crate) unsafe fn free(c: fmi2Component) {
    // SAFETY: passed on to the caller.
    let Some(component) = (unsafe { pointers::take(c) }) else {
        return;
    };
    let Component { mut instance, host } = *component;
    let closed = {
        let _host = HostRounding::set_aside();
        catch_unwind(AssertUnwindSafe(move || {
            instance.close();
            instance.end_call()
        }))
    };
    let messages =
        closed.unwrap_or_else(|panic| vec![message_of_panic(Function::FreeInstance.name(), panic)]);
    host.deliver(&messages);
}

/// Runs `body`, and returns the status with the messages that the importer wants.
fn run(
    instance: &mut Instance,
    function: Function,
    body: impl FnOnce(&mut Instance) -> Result<(), Error>,
) -> (Status, Vec<Message>) {
    let _host = HostRounding::set_aside();
    let state = instance.state();
    if !function.allowed_in(state) {
        let text = format!(
            "{} is not allowed: the instance is {state}",
            function.name()
        );
        let message = Message {
            status: Status::Error,
            category: Category::Error,
            text,
        };
        return (Status::Error, vec![message]);
    }
    // A panic may leave the instance half changed. It is fatal from then on and never read again,
    // so that unwinding through the reference is safe.
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        instance.begin_call();
        let result = body(instance);
        (result, instance.end_call())
    }));
    let served = match instance.has_warned() {
        true => Status::Warning,
        false => Status::Ok,
    };
    match outcome {
        Ok((Ok(()), messages)) => (served, messages),
        Ok((Err(error), mut messages)) => {
            let message = message_of(function.name(), &error);
            let status = message.status;
            if instance.wants(&message) {
                messages.push(message);
            }
            (status, messages)
        }
        Err(panic) => {
            instance.lose();
            (
                Status::Fatal,
                vec![message_of_panic(function.name(), panic)],
            )
        }
    }
}

fn message_of(function: &str, error: &Error) -> Message {
    let (status, category) = error.status();
    Message {
        status,
        category,
        text: format!("{function}: {error}"),
    }
}

fn message_of_panic(function: &str, panic: Box<dyn Any + Send>) -> Message {
    let reason = panic
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "no reason given".to_owned());
    let text = format!(
        "{function}: internal error ({reason}); the instance is lost and can only be freed"
    );
    Message {
        status: Status::Fatal,
        category: Category::Fatal,
        text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lifecycle::State;

    #[test]
    fn a_panic_is_caught_and_the_instance_lost() {
        // SAFETY: without callbacks nothing is ever called.
        let host = unsafe { Host::new("x", None) };
        let c = instantiate(host, || Ok(Instance::for_tests()));
        // SAFETY: `c` is alive until it is freed and used by nobody else.
        unsafe {
            let status = call(c, Function::SetReal, |_| panic!("planted for this test"));
            assert_eq!(status, Status::Fatal.code());
            for function in Function::ALL {
                if *function != Function::FreeInstance {
                    assert_eq!(call(c, *function, |_| Ok(())), Status::Error.code());
                }
            }
            free(c);
        }
    }

    #[test]
    fn a_panic_says_what_happened() {
        let mut instance = Instance::for_tests();
        let body = |_: &mut Instance| -> Result<(), Error> { panic!("reason {}", 7) };
        let (status, messages) = run(&mut instance, Function::SetReal, body);
        assert_eq!((status, messages[0].status), (Status::Fatal, Status::Fatal));
        assert!(
            messages[0].text.contains("reason 7"),
            "{}",
            messages[0].text
        );
        assert_eq!(instance.state(), State::Fatal);
    }

    #[test]
    fn a_panic_while_instantiating_gives_null() {
        // SAFETY: without callbacks nothing is ever called.
        let host = unsafe { Host::new("x", None) };
        assert!(instantiate(host, || panic!("planted for this test")).is_null());
    }

    #[test]
    fn calls_out_of_state_never_reach_the_body() {
        let mut instance = Instance::for_tests();
        let body = |_: &mut Instance| -> Result<(), Error> { panic!("must not run") };
        let (status, messages) = run(&mut instance, Function::DoStep, body);
        assert_eq!(status, Status::Error);
        assert_eq!(
            messages[0].text,
            "fmi2DoStep is not allowed: the instance is instantiated"
        );
        assert_eq!(instance.state(), State::Instantiated);
    }
}
