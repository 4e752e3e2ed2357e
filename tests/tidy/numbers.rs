//! Which functions results may go through.

use super::sources::{Source, production};
use super::{all_sources, caught, none};

/// Methods of numbers that each platform's library rounds as it likes; `libm` rounds them alike everywhere.
const OF_THE_PLATFORM: [&str; 25] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp",
    "exp2", "exp_m1", "hypot", "ln", "ln_1p", "log", "log10", "log2", "powf", "sin", "sin_cos",
    "sinh", "tan", "tanh",
];

/// Calls of such methods outside of command, laboratory and tests. `angle` between a vector and another one is one of them.
fn platform_calls(sources: &[Source]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (file, words) in production(sources) {
        if file.starts_with("src/cli/") || file.starts_with("src/lab/") {
            continue;
        }
        for at in words.windows(4) {
            let [on, name, open, argument] = [0, 1, 2, 3].map(|k| at[k].text.as_str());
            let method = on == "." && open == "(";
            let listed = OF_THE_PLATFORM.contains(&name);
            if method && (listed || name == "angle" && argument == "&")
                || (["f32", "f64"].contains(&on) && name == "::" && OF_THE_PLATFORM.contains(&open))
            {
                let called = if method { name } else { open };
                wrong.push(format!("{file}:{}: {called}", at[1].line));
            }
        }
    }
    wrong
}

#[test]
fn results_go_through_the_same_functions_on_every_platform() {
    none(&platform_calls(&all_sources()));
}

#[test]
fn a_function_of_the_platform_is_caught() {
    let source = |path, text| [Source::new(path, text)];
    let all = "fn f(x: f64) -> f64 {\n x.sin()\n + a.angle(&b)\n + map(f64::exp) }";
    let violations = platform_calls(&source("src/rod/mod.rs", all));
    caught(&violations, "src/rod/mod.rs:2: sin");
    caught(&violations, "src/rod/mod.rs:3: angle");
    caught(&violations, "src/rod/mod.rs:4: exp");
    let other = "fn f() { libm::sin(x) + law.angle(time) + x.sqrt() }\n// x.sin()";
    none(&platform_calls(&source("src/rod/mod.rs", other)));
    let test = format!("#[cfg(test)]\nmod tests {{ {all} }}");
    none(&platform_calls(&source("src/rod/mod.rs", &test)));
    none(&platform_calls(&source("src/lab/mod.rs", all)));
}
