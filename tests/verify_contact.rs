//! Contact, friction and feed against exact answers: the packed reference cases, by the production
//! method and by the paper's.

use coilwind::lab::verify::{VerifyOptions, run};
use coilwind::scene::Preset;

fn all_right(kind: &str, preset: Preset) {
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

macro_rules! kinds {
    ($preset:ident = $value:expr; $($kind:ident),* $(,)?) => {
        mod $preset {
            use coilwind::scene::Preset;

            $(#[test]
            fn $kind() {
                super::all_right(stringify!($kind), $value);
            })*
        }
    };
}

kinds!(
    default = Preset::Default;
    capstan,
    frozen_helix,
    grooved_capstan,
    groove_seat,
    helix_gap,
    live_pair,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    twist_buckling,
    winding_feed,
);

kinds!(
    paper = Preset::Paper;
    capstan,
    grooved_capstan,
    groove_seat,
    // counts for this preset only
    penalty_impact,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    winding_feed,
);
