//! Contact, friction and feed against exact answers: the packed reference cases.

use coilwind::verify::{VerifyArgs, run};

fn all_right(kind: &str) {
    let args = VerifyArgs {
        kinds: vec![kind.to_owned()],
        // penalty_impact counts for this preset only
        preset: "paper".to_owned(),
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
    ($($kind:ident),*) => {$(
        #[test]
        fn $kind() {
            all_right(stringify!($kind));
        }
    )*};
}

kinds!(
    capstan,
    groove_seat,
    penalty_impact,
    shoulder_drop,
    shoulder_static,
    spinning_ring,
    twist_buckling,
    winding_feed
);
