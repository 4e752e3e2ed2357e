//! The rod against exact answers: the packed reference cases.

use coilwind::verify::{VerifyArgs, run};

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
    println!("{table}");
    assert_eq!(right, Ok(true), "\n{table}");
}

macro_rules! kinds {
    ($($kind:ident),* $(,)?) => {
        $(#[test]
        fn $kind() {
            all_right(stringify!($kind), "default");
        })*
    };
}

kinds!(
    elastica_cantilever,
    end_couple,
    bending_modes,
    axial_wave,
    torsion,
    hanging_wire,
    helix,
    mandrel_springback,
    cyclic_bending,
    bulge_linear,
    corner_edge,
    square_loop,
);
