//! Defects and verdicts in words.

use super::defect::{BulgeLimit, Defect, DefectKind};
use super::turn::{TurnMeasures, Verdict};

impl Defect {
    /// What it is, how large, where, and where it was found, as a sentence without its full stop.
    pub fn in_words(&self) -> String {
        let found = match (self.found_turn, self.found_angle_deg) {
            place if place == (self.turn, self.angle_deg) => String::new(),
            (turn, angle) => format!("; found in turn {turn} at {angle:.0} deg"),
        };
        let place = format!(
            "in turn {} (layer {}) at {:.0} deg, t = {:.6} s{found}",
            self.turn, self.layer, self.angle_deg, self.time_s
        );
        match (self.kind, self.size_m, self.size_d) {
            (DefectKind::Break, ..) => {
                format!("the wire broke {place}; nothing was wound after that")
            }
            (DefectKind::Collision, ..) => {
                format!("the nozzle collided {place}; nothing was wound after that")
            }
            (DefectKind::Runaway, ..) => {
                format!("the wire ran away from the nozzle {place}; nothing was wound after that")
            }
            (DefectKind::Slack, ..) => format!("the wire went slack {place}"),
            (DefectKind::EarlyJump | DefectKind::LateJump, _, Some(turns)) => {
                format!("{} by {turns:.1} turns {place}", self.kind.words())
            }
            (DefectKind::LooseTurn, Some(m), _) => {
                format!(
                    "loose turn: it stands up to {:.3} mm off what it was laid over, {place}",
                    1e3 * m
                )
            }
            (DefectKind::LooseTurn, None, _) => {
                format!(
                    "loose turn: its tension is below the share defects.loose_tension of tensioner.tension, {place}"
                )
            }
            (DefectKind::Overstretch, Some(m), _) => {
                format!("overstretch, {:.3} mm a turn, {place}", 1e3 * m)
            }
            (kind, Some(m), Some(d)) => {
                format!("{} of {:.3} mm ({d:.2} d) {place}", kind.words(), 1e3 * m)
            }
            (kind, ..) => format!("{} {place}", kind.words()),
        }
    }
}

/// The word that stands in place of a verdict where a run failed.
///
/// It is no [`Verdict`]: wire that came to rest before keeps the verdict of its turn.
pub const UNJUDGED: &str = "unjudged";

/// Why a run has its verdict: a sentence for each reason, the gravest first.
///
/// `diameter` is that of the wire, m.
pub fn reasons(
    verdict: Verdict,
    defects: &[Defect],
    turns: &[TurnMeasures],
    judged: BulgeLimit,
    diameter: f64,
) -> Vec<String> {
    let mut reasons = of_all_kinds(defects);
    let off_grooves = out_of_grooves(turns);
    if reasons.is_empty() {
        reasons.extend(without_defect(verdict, turns, diameter, &off_grooves));
    }
    reasons.extend(off_grooves);
    reasons.extend(about_bulges(judged, diameter));
    reasons
}

/// How much of the wire the verdict leaves out, since it had been laid and was not at rest when the run ended; `None` for less
/// than a degree. Counted in turns.
pub fn left_out(wound: f64, settled: f64) -> Option<String> {
    let rest = wound - settled;
    // Where nothing has come to rest the verdict says so itself.
    (settled > 0.0 && rest > 1.0 / 360.0).then(|| {
        format!(
            "The last {rest:.2} turns are not judged: they lie too near to where wire is laid, or had not come to rest when the run ended"
        )
    })
}

/// That a run was interrupted at a time, s: of what it had still to wind, nothing is known.
pub fn interrupted(time: f64) -> String {
    format!("The run was interrupted at t = {time:.6} s: what was not wound by then has no verdict")
}

/// How much of the planned layers is wound, where more than half a turn is missing. Counted in turns.
pub fn unfinished(wound: f64, planned: f64) -> Option<String> {
    (planned - wound > 0.5).then(|| {
        format!("{wound:.2} of {planned:.0} turns of the planned layers are wound: the rest has no verdict")
    })
}

/// How many turns stand on wire of the layer below instead of in its grooves, and which does most.
fn out_of_grooves(turns: &[TurnMeasures]) -> Option<String> {
    let out = || turns.iter().filter(|turn| !turn.is_in_groove());
    let most = out()
        .rev()
        .max_by(|a, b| a.out_of_groove.total_cmp(&b.out_of_groove))?;
    let turns = match out().count() {
        1 => "1 turn stands".to_owned(),
        count => format!("{count} turns stand"),
    };
    Some(format!(
        "{turns} on wire of the layer below instead of in its grooves; the longest: turn {} (layer {}), over {:.0} % of its angles, crossovers not counted",
        most.turn,
        most.layer,
        100.0 * most.out_of_groove
    ))
}

/// What a reader has to know of the limit by which bulges are judged, if anything.
fn about_bulges(judged: BulgeLimit, diameter: f64) -> Option<String> {
    match judged {
        BulgeLimit::Fallback { limit_m } => Some(format!(
            "The height of this wire at rest on this core is not known: a bulge is judged by {:.3} mm",
            1e3 * limit_m
        )),
        BulgeLimit::OverRest { highest_m, .. } if highest_m > diameter => Some(format!(
            "Even drawn tight at rest, this wire stands up to {:.3} mm ({:.1} d) off the core: that much is not judged a bulge; more tension or thinner wire lies closer",
            1e3 * highest_m,
            highest_m / diameter
        )),
        _ => None,
    }
}

/// Why a run that failed is [`UNJUDGED`]: what it failed with, then the defects found until then, the gravest first.
pub fn reasons_unjudged(failure: &str, defects: &[Defect]) -> Vec<String> {
    let why = format!("because the run failed before its planned end: {failure}");
    not_judged(&why, defects)
}

/// The same for a run whose own numbers contradict each other: `doubt` says how.
pub fn reasons_doubted(doubt: &str, defects: &[Defect]) -> Vec<String> {
    not_judged(&format!("because the run is in doubt: {doubt}"), defects)
}

fn not_judged(why: &str, defects: &[Defect]) -> Vec<String> {
    let mut reasons = vec![format!("Not judged, {why}")];
    let found = of_all_kinds(defects);
    reasons.extend(
        found
            .iter()
            .map(|words| format!("Found until then: {words}")),
    );
    reasons
}

/// A sentence for each kind of defect that there is, the gravest first.
fn of_all_kinds(defects: &[Defect]) -> Vec<String> {
    let kinds = DefectKind::ALL.into_iter();
    kinds.filter_map(|kind| of_kind(kind, defects)).collect()
}

/// The defects of one kind: how many, and the largest.
fn of_kind(kind: DefectKind, defects: &[Defect]) -> Option<String> {
    let of_kind = || defects.iter().filter(|defect| defect.kind == kind);
    // The first of several that are equally large.
    let worst = of_kind().rev().max_by(|a, b| {
        let size = |defect: &Defect| defect.size_m.unwrap_or(0.0);
        size(a).total_cmp(&size(b))
    })?;
    let words = match of_kind().count() {
        1 => worst.in_words(),
        count => {
            let which = match worst.size_m {
                Some(_) => "the gravest",
                None => "the first",
            };
            format!(
                "{count} times {}; {which}: {}",
                kind.words(),
                worst.in_words()
            )
        }
    };
    let mut letters = words.chars();
    Some(letters.next()?.to_uppercase().chain(letters).collect())
}

/// The reason for a verdict that no defect gave; `None` where it is what is said of grooves.
fn without_defect(
    verdict: Verdict,
    turns: &[TurnMeasures],
    diameter: f64,
    off_grooves: &Option<String>,
) -> Option<String> {
    Some(match verdict {
        Verdict::Unsettled => {
            "No wire has come to rest where it could be judged; wind more turns".to_owned()
        }
        Verdict::Single => "No defect, and no turn with a neighbour to be judged by".to_owned(),
        Verdict::Aligned => {
            "No defect; every judged turn lies beside its neighbour within 0.10 d at 95 % of its angles, crossovers not counted"
                .to_owned()
        }
        _ => {
            let loosest = turns
                .iter()
                .filter(|turn| turn.verdict == verdict && turn.is_in_groove())
                .filter_map(|turn| Some((turn, turn.gap_rms?)))
                .max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((turn, rms)) = loosest else {
                let other = format!("The verdict is {verdict}, and no defect was found");
                return off_grooves.is_none().then_some(other);
            };
            format!(
                "No defect, but wire lies less closely than in an aligned coil: the gap of turn {} is {:.3} mm rms ({:.2} d)",
                turn.turn,
                1e3 * rms,
                rms / diameter
            )
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(turn: u32, size_m: f64) -> Defect {
        Defect {
            kind: DefectKind::Gap,
            turn,
            layer: 1,
            angle_deg: 210.0,
            found_turn: turn,
            found_angle_deg: 170.0,
            time_s: 0.02,
            until_s: None,
            size_m: Some(size_m),
            size_d: Some(size_m / 0.7e-3),
            place_m: [0.0; 3],
        }
    }

    /// A coil of which two thirds were missing was aligned without a word of that.
    #[test]
    fn a_coil_that_is_not_finished_is_told_so() {
        let said = unfinished(9.32, 30.0).expect("not finished");
        let expected = "9.32 of 30 turns of the planned layers are wound: the rest has no verdict";
        assert_eq!(said, expected);
        // where the free span ends goes to and fro by a part of a turn
        assert_eq!(unfinished(29.6, 30.0), None);
    }

    #[test]
    fn the_largest_of_several_defects_is_named() {
        let judged = BulgeLimit::Absolute { limit_m: 1e-3 };
        let defects = [gap(2, 0.14e-3), gap(3, 0.21e-3)];
        let said = reasons(Verdict::Gap, &defects, &[], judged, 0.7e-3);
        assert_eq!(
            said,
            [
                "2 times gap; the gravest: gap of 0.210 mm (0.30 d) in turn 3 (layer 1) at 210 deg, t = 0.020000 s; found in turn 3 at 170 deg"
            ]
        );
        let said = reasons(Verdict::Gap, &defects[..1], &[], judged, 0.7e-3);
        assert!(
            said[0].starts_with("Gap of 0.140 mm (0.20 d) in turn 2"),
            "{said:?}"
        );
    }

    /// Up to 1.4 turns that had been laid were not judged without a word.
    #[test]
    fn turns_laid_and_not_judged_are_told() {
        assert_eq!(
            left_out(31.71, 31.38).unwrap(),
            "The last 0.33 turns are not judged: they lie too near to where wire is laid, or had not come to rest when the run ended"
        );
        assert_eq!(left_out(2.0, 2.0), None);
        assert_eq!(left_out(0.8, 0.0), None, "the verdict says it");
    }

    #[test]
    fn a_run_that_failed_is_not_judged_and_keeps_what_it_found() {
        let said = reasons_unjudged("at t = 0.1 s: not finite", &[]);
        assert_eq!(
            said,
            ["Not judged, because the run failed before its planned end: at t = 0.1 s: not finite"]
        );
        let said = reasons_doubted("too deep", &[]);
        assert_eq!(said, ["Not judged, because the run is in doubt: too deep"]);
        let said = reasons_unjudged("", &[gap(2, 0.14e-3)]);
        assert!(
            said[1].starts_with("Found until then: Gap of 0.140 mm"),
            "{said:?}"
        );
    }

    /// Slack has no size, and the first was called the gravest.
    #[test]
    fn of_defects_without_a_size_the_first_is_named() {
        let slack = |turn| Defect {
            kind: DefectKind::Slack,
            size_m: None,
            size_d: None,
            ..gap(turn, 0.0)
        };
        let judged = BulgeLimit::Absolute { limit_m: 1e-3 };
        let said = reasons(Verdict::Slack, &[slack(2), slack(5)], &[], judged, 0.7e-3);
        assert!(
            said[0].starts_with("2 times slack; the first: the wire went slack in turn 2"),
            "{said:?}"
        );
    }

    #[test]
    fn a_limit_that_was_fallen_back_on_is_told() {
        let judged = BulgeLimit::Fallback { limit_m: 0.7e-3 };
        let turn = TurnMeasures {
            turn: 2,
            gap_rms: Some(0.07e-3),
            verdict: Verdict::Marginal,
            ..TurnMeasures::default()
        };
        let said = reasons(Verdict::Marginal, &[], &[turn], judged, 0.7e-3);
        assert!(
            said[0].contains("turn 2 is 0.070 mm rms (0.10 d)"),
            "{said:?}"
        );
        assert!(said[1].contains("judged by 0.700 mm"), "{said:?}");
    }

    /// Turns that stood on those of the layer below were called aligned, and nobody was told.
    #[test]
    fn turns_out_of_their_grooves_are_told() {
        let judged = BulgeLimit::Absolute { limit_m: 1e-3 };
        let turn = |turn, out_of_groove, verdict| TurnMeasures {
            turn,
            layer: 2,
            out_of_groove,
            verdict,
            ..TurnMeasures::default()
        };
        let turns = [
            turn(17, 0.31, Verdict::Marginal),
            turn(18, 0.02, Verdict::Aligned),
            turn(19, 0.27, Verdict::Marginal),
        ];
        let words = "2 turns stand on wire of the layer below instead of in its grooves; the longest: turn 17 (layer 2), over \
                     31 % of its angles, crossovers not counted";
        let said = reasons(Verdict::Marginal, &[], &turns, judged, 0.7e-3);
        assert_eq!(said, [words]);
        let said = reasons(Verdict::Gap, &[gap(2, 0.2e-3)], &turns, judged, 0.7e-3);
        assert_eq!(said[1], words);
    }

    /// Wire of 1 N stood 3.7 diameters off the core at rest, and its verdict said "No defect" and no more.
    #[test]
    fn wire_that_stands_off_at_rest_is_told() {
        let judged = |highest_m| BulgeLimit::OverRest {
            limit_m: 0.35e-3,
            highest_m,
        };
        let said = reasons(Verdict::Aligned, &[], &[], judged(2.6e-3), 0.7e-3);
        assert!(
            said[1].contains("stands up to 2.600 mm (3.7 d) off the core"),
            "{said:?}"
        );
        let said = reasons(Verdict::Aligned, &[], &[], judged(0.6e-3), 0.7e-3);
        assert_eq!(said.len(), 1, "{said:?}");
    }

    /// The turn with the widest gaps was named although too little of it had a neighbour, so that it was no reason.
    #[test]
    fn a_marginal_coil_is_marginal_for_a_turn_that_is() {
        let judged = BulgeLimit::Absolute { limit_m: 1e-3 };
        let turn = |turn, gap_rms, verdict| TurnMeasures {
            turn,
            gap_rms: Some(gap_rms),
            verdict,
            ..TurnMeasures::default()
        };
        let turns = [
            turn(2, 0.05e-3, Verdict::Marginal),
            turn(3, 0.09e-3, Verdict::Single),
        ];
        let said = reasons(Verdict::Marginal, &[], &turns, judged, 0.7e-3);
        assert!(said[0].contains("turn 2 is 0.050 mm rms"), "{said:?}");
    }
}
