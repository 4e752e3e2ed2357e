//! The table of calls that each state of an instance allows (FMI 2.0.5, section 4.2.4).

use serde::{Deserialize, Serialize};
use std::fmt;

/// State of an instance between two calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum State {
    /// After `fmi2Instantiate` or `fmi2Reset`.
    Instantiated,
    /// Between `fmi2EnterInitializationMode` and `fmi2ExitInitializationMode`.
    Initialization,
    /// At a communication point.
    StepComplete,
    /// After a step in which the solver gave up.
    StepFailed,
    /// After `fmi2Terminate`.
    Terminated,
    /// After a caught panic. Nothing about the instance can be trusted.
    Fatal,
}

// One bit per state, in the order of `State`.
const I: u8 = 1;
const M: u8 = 1 << 1;
const C: u8 = 1 << 2;
const F: u8 = 1 << 3;
const T: u8 = 1 << 4;
const X: u8 = 1 << 5;

impl State {
    /// Every state.
    #[cfg(test)]
    pub(crate) const ALL: [State; 6] = [
        State::Instantiated,
        State::Initialization,
        State::StepComplete,
        State::StepFailed,
        State::Terminated,
        State::Fatal,
    ];

    fn bit(self) -> u8 {
        match self {
            State::Instantiated => I,
            State::Initialization => M,
            State::StepComplete => C,
            State::StepFailed => F,
            State::Terminated => T,
            State::Fatal => X,
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            State::Instantiated => "instantiated",
            State::Initialization => "in initialization mode",
            State::StepComplete => "at a communication point (step complete)",
            State::StepFailed => "in a failed step",
            State::Terminated => "terminated",
            State::Fatal => "lost after an internal error",
        })
    }
}

/// Declares the functions together with the states that allow them.
macro_rules! functions {
    ($($function:ident = $name:literal in $states:expr;)*) => {
        /// A C function that takes an instance.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Function { $($function),* }

        impl Function {
            /// Every function.
            #[cfg(test)]
            pub(crate) const ALL: &[Function] = &[$(Function::$function),*];

            /// Returns the name in C.
            pub(crate) fn name(self) -> &'static str {
                match self { $(Function::$function => $name),* }
            }

            fn states(self) -> u8 {
                match self { $(Function::$function => $states),* }
            }
        }
    };
}

functions! {
    SetDebugLogging = "fmi2SetDebugLogging" in I | M | C | F | T;
    FreeInstance = "fmi2FreeInstance" in I | M | C | F | T | X;
    SetupExperiment = "fmi2SetupExperiment" in I;
    EnterInitializationMode = "fmi2EnterInitializationMode" in I;
    ExitInitializationMode = "fmi2ExitInitializationMode" in M;
    Terminate = "fmi2Terminate" in C | F;
    Reset = "fmi2Reset" in I | M | C | F | T;
    GetReal = "fmi2GetReal" in M | C | F | T;
    GetInteger = "fmi2GetInteger" in M | C | F | T;
    GetBoolean = "fmi2GetBoolean" in M | C | F | T;
    GetString = "fmi2GetString" in M | C | F | T;
    SetReal = "fmi2SetReal" in I | M | C;
    SetInteger = "fmi2SetInteger" in I | M | C;
    SetBoolean = "fmi2SetBoolean" in I | M | C;
    SetString = "fmi2SetString" in I | M | C;
    GetFMUstate = "fmi2GetFMUstate" in I | M | C | F | T;
    SetFMUstate = "fmi2SetFMUstate" in I | M | C | F | T;
    FreeFMUstate = "fmi2FreeFMUstate" in I | M | C | F | T;
    SerializedFMUstateSize = "fmi2SerializedFMUstateSize" in I | M | C | F | T;
    SerializeFMUstate = "fmi2SerializeFMUstate" in I | M | C | F | T;
    DeSerializeFMUstate = "fmi2DeSerializeFMUstate" in I | M | C | F | T;
    GetDirectionalDerivative = "fmi2GetDirectionalDerivative" in M | C | F | T;
    SetRealInputDerivatives = "fmi2SetRealInputDerivatives" in I | M | C;
    GetRealOutputDerivatives = "fmi2GetRealOutputDerivatives" in C | F | T;
    DoStep = "fmi2DoStep" in C;
    // Steps are never in progress between two calls.
    CancelStep = "fmi2CancelStep" in 0;
    GetStatus = "fmi2GetStatus" in C | F | T;
    GetRealStatus = "fmi2GetRealStatus" in C | F | T;
    GetIntegerStatus = "fmi2GetIntegerStatus" in C | F | T;
    GetBooleanStatus = "fmi2GetBooleanStatus" in C | F | T;
    GetStringStatus = "fmi2GetStringStatus" in C | F | T;
}

impl Function {
    /// Tells whether the standard allows the call in that state.
    pub(crate) fn allowed_in(self, state: State) -> bool {
        self.states() & state.bit() != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table once more, state by state, as a reader of the standard would write it down.
    fn expected(state: State) -> Vec<&'static str> {
        let getters = [
            "fmi2GetReal",
            "fmi2GetInteger",
            "fmi2GetBoolean",
            "fmi2GetString",
        ];
        let setters = [
            "fmi2SetReal",
            "fmi2SetInteger",
            "fmi2SetBoolean",
            "fmi2SetString",
        ];
        let states = [
            "fmi2GetFMUstate",
            "fmi2SetFMUstate",
            "fmi2FreeFMUstate",
            "fmi2SerializedFMUstateSize",
            "fmi2SerializeFMUstate",
            "fmi2DeSerializeFMUstate",
        ];
        let statuses = [
            "fmi2GetStatus",
            "fmi2GetRealStatus",
            "fmi2GetIntegerStatus",
            "fmi2GetBooleanStatus",
            "fmi2GetStringStatus",
        ];
        let mut names = vec!["fmi2FreeInstance"];
        if state == State::Fatal {
            return names;
        }
        names.extend(["fmi2Reset", "fmi2SetDebugLogging"]);
        names.extend(states);
        let after_start =
            [State::StepComplete, State::StepFailed, State::Terminated].contains(&state);
        if after_start {
            names.extend(statuses);
            names.push("fmi2GetRealOutputDerivatives");
        }
        if after_start || state == State::Initialization {
            names.extend(getters);
            names.push("fmi2GetDirectionalDerivative");
        }
        match state {
            State::Instantiated => {
                names.extend(setters);
                names.extend([
                    "fmi2SetupExperiment",
                    "fmi2EnterInitializationMode",
                    "fmi2SetRealInputDerivatives",
                ]);
            }
            State::Initialization => {
                names.extend(setters);
                names.extend(["fmi2ExitInitializationMode", "fmi2SetRealInputDerivatives"]);
            }
            State::StepComplete => {
                names.extend(setters);
                names.extend(["fmi2DoStep", "fmi2Terminate", "fmi2SetRealInputDerivatives"]);
            }
            State::StepFailed => names.push("fmi2Terminate"),
            State::Terminated | State::Fatal => {}
        }
        names
    }

    #[test]
    fn every_function_in_every_state() {
        for state in State::ALL {
            let mut allowed: Vec<_> = Function::ALL
                .iter()
                .filter(|function| function.allowed_in(state))
                .map(|function| function.name())
                .collect();
            let mut expected = expected(state);
            allowed.sort_unstable();
            expected.sort_unstable();
            assert_eq!(allowed, expected, "{state:?}");
        }
    }
}
