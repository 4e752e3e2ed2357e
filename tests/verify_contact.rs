//! Contact, friction and feed against exact answers: the packed reference cases, by the production
//! method and by the paper's.

use coilwind::lab::verify::{VerifyArgs, run};

fn all_right(kind: &str, preset: &str) {
    let args = VerifyArgs {
        kinds: vec![kind.to_owned()],
        preset: preset.to_owned(),
        ..VerifyArgs::default()
    };
    let mut table = String::new();
    let right = run(&args, |line| {
        table.push_str(line);
        table.push('\n');
    });
    assert_eq!(right, Ok(true), "\n{table}");
}

macro_rules! kinds {
    ($preset:ident: $($kind:ident),* $(,)?) => {
        mod $preset {
            $(#[test]
            fn $kind() {
                super::all_right(stringify!($kind), stringify!($preset));
            })*
        }
    };
}

kinds!(
    default: capstan,
    groove_seat,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    twist_buckling,
    winding_feed,
);

kinds!(
    paper: capstan,
    groove_seat,
    // counts for this preset only
    penalty_impact,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    winding_feed,
);
