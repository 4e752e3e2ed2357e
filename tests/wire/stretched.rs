//! What is said of wire that has been drawn thinner, or bent sharply.

use coilwind::settings::SceneSettings;
use coilwind::simulation::{Simulation, Summary};
use std::path::Path;

/// Three turns on a round core under a tension, N. The soft wire of 0.6 mm yields from 20 N on.
fn wound_under(tension: f64) -> Summary {
    wound_on("shape = 'cylinder'\nradius_mm = 6", tension)
}

/// Three turns on a core of 8 mm along its axis.
fn wound_on(core: &str, tension: f64) -> Summary {
    let text = format!(
        "[wire]\ndiameter_mm = 0.6\nmaterial = 'copper-soft'\n[core]\n{core}\nlength_y_mm = 8\n\
         [nozzle]\ndistance_mm = 20\ny_start_mm = -2\n[start]\nclamp_y_mm = -2\n[tensioner]\ntension = {tension}\n\
         [spindle]\nspeed = 60\nramp_turns = 0.2\nturns = 3\n[traverse]\nmode = 'by-angle'\nper_turn_mm = 0.6\n"
    );
    let settings = SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
    let mut run = Simulation::new(&settings.build().expect("a scene")).expect("starts");
    run.advance_profile(run.motion_profile().end())
        .expect("a way there");
    run.winding().summary()
}

/// Wire stretched by a fifth lies and is measured with the diameter that it had, and nothing said so.
#[test]
fn wire_that_is_drawn_thinner_is_told_with_the_diameter_that_is_left() {
    let thinner = |summary: &Summary| -> Vec<String> {
        let reasons = summary.reasons.iter();
        let of_diameter = reasons.filter(|reason| reason.contains("of the diameter of"));
        of_diameter.cloned().collect()
    };
    let stretched = wound_under(45.0);
    let left = stretched.product.thinnest_diameter_m;
    let stretch = (0.6e-3 / left).powi(2) - 1.0;
    assert!((0.15..0.3).contains(&stretch), "{stretch}");
    let said = thinner(&stretched);
    let words = format!("plastic stretch of {:.1} % in turn ", 1e2 * stretch);
    assert!(
        said.len() == 1 && said[0].contains(&words),
        "{words}: {said:?}"
    );
    let words = format!("leaves {:.3} mm of the diameter of 0.600 mm", 1e3 * left);
    assert!(said[0].contains(&words), "{words}: {said:?}");

    let usual = wound_under(15.0);
    let left = usual.product.thinnest_diameter_m;
    assert!(left <= 0.6e-3 && left > 0.995 * 0.6e-3, "{left}");
    assert!(thinner(&usual).is_empty(), "{:?}", usual.reasons);
}

/// Wire whose outside was stretched by half round a sharp corner was "aligned" without a word, though it may crack there.
#[test]
fn wire_bent_more_sharply_than_it_is_tested_is_told_so() {
    let sharp = |corner: f64| -> Vec<String> {
        let core = format!(
            "shape = 'rounded-box'\nwidth_x_mm = 8\nheight_z_mm = 8\ncorner_radius_mm = {corner}"
        );
        let reasons = wound_on(&core, 22.0).reasons.into_iter();
        reasons.filter(|reason| reason.contains("cracks")).collect()
    };
    let said = sharp(0.05);
    assert_eq!(said.len(), 1, "{said:?}");
    let told = said[0].contains("% of strain on its outside, in turn ")
        && said[0].ends_with("winding wire is tested to 50 %");
    assert!(told, "{said:?}");
    // an inner radius of the wire's diameter strains it by a third
    assert_eq!(sharp(0.6), Vec::<String>::new());
}
