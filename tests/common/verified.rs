//! The packed cases of a kind of exact answer, judged.

use coilwind::lab::verify::{VerifyOptions, run};
use coilwind::scene::Preset;

/// Every number of this kind is right.
pub fn all_right(kind: &str, preset: Preset) {
    let args = VerifyOptions {
        kinds: vec![kind.to_owned()],
        preset,
        ..VerifyOptions::default()
    };
    let mut table = String::new();
    let right = run(&args, |line| {
        table.push_str(line);
        table.push('\n');
    });
    assert_eq!(right, Ok(true), "\n{table}");
}
