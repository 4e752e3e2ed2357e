//! `--find-max`: the highest value at which no member of the ensemble has a defect, by bisection.

use super::failure::Failure;
use super::sweep_range::Range;
use super::sweep_row::Row;
use serde::Serialize;

/// The drive of a spindle is set in steps of about 5 rad/s: bisection chooses among values at most so far apart.
const STEPS: [(&str, f64); 2] = [
    ("spindle.speed", 5.0),
    ("spindle.speed_rpm", 5.0 * 30.0 / std::f64::consts::PI),
];

/// The values that bisection chooses from: those of the range, and for the spindle's speed more between them.
///
/// # Errors
/// Where there is not exactly one range, of this variable and with a length.
pub(super) fn candidates(name: &str, ranges: &[Range]) -> Result<Range, Failure> {
    let refuse = |reason: &str| {
        Failure::sweep(format!(
            "--find-max {name}: {reason}; allowed: one --over {name}=A:B:N with A below B"
        ))
    };
    let [range] = ranges else {
        return Err(refuse("there are several ranges"));
    };
    if range.name != name {
        return Err(refuse(&format!("the range is one of {}", range.name)));
    }
    if range.from == range.to {
        return Err(refuse("the bracket is a single value"));
    }
    let step = STEPS.iter().find(|(known, _)| *known == name);
    Ok(step.map_or_else(|| range.clone(), |(_, step)| range.refined_to(*step)))
}

/// What a look at a value says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "look", rename_all = "snake_case")]
pub(super) enum Look {
    /// every run ended, was judged, and has no defect
    Free,
    /// a run has a defect
    Defect,
    /// no run has a defect, and so many cannot be judged or were given up by the solver
    Unknown {
        unjudged: usize,
        failed: usize,
        of: usize,
    },
}

impl Look {
    /// What the rows at a value say together. A defect that was found counts, whatever came after it.
    pub(super) fn at(rows: &[&Row]) -> Self {
        let count = |is: fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count();
        let (unjudged, failed) = (count(Row::is_unjudged), count(Row::failed));
        match (count(|row| row.defect), unjudged + failed) {
            (0, 0) => Self::Free,
            (0, _) => Self::Unknown {
                unjudged,
                failed,
                of: rows.len(),
            },
            _ => Self::Defect,
        }
    }
}

/// What bisection came to.
#[derive(Debug, PartialEq)]
pub(super) struct Limit {
    /// candidates from the first that are free of defects
    pub(super) free: usize,
    /// first candidate that is known to have a defect; as many as there are where none is
    pub(super) end: usize,
    /// the candidate between them that says neither, which ended the search
    pub(super) unknown: Option<(usize, Look)>,
}

/// How many of the first `count` candidates are free of defects, where those above a limit have one and those below have none.
/// Each look winds an ensemble, so it takes as few as possible. A look that says neither ends the search.
///
/// # Errors
/// Those of `look`.
pub(super) fn bisect<E>(
    count: usize,
    mut look: impl FnMut(usize) -> Result<Look, E>,
) -> Result<Limit, E> {
    let (mut free, mut end) = (0, count);
    let mut unknown = None;
    while free < end && unknown.is_none() {
        let middle = free + (end - free) / 2;
        match look(middle)? {
            Look::Free => free = middle + 1,
            Look::Defect => end = middle,
            neither => unknown = Some((middle, neither)),
        }
    }
    Ok(Limit { free, end, unknown })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_finds_every_limit_in_a_tenth_of_the_candidates() {
        for limit in 0..=81 {
            let mut looks = Vec::new();
            let found = bisect(81, |index| {
                looks.push(index);
                Ok::<Look, ()>(match index < limit {
                    true => Look::Free,
                    false => Look::Defect,
                })
            });
            let exact = Limit {
                free: limit,
                end: limit,
                unknown: None,
            };
            assert_eq!(found, Ok(exact));
            assert!(looks.len() <= 7, "{limit}: {looks:?}");
            // What is told was wound: the last that is free and the first that is not.
            assert!(limit == 0 || looks.contains(&(limit - 1)));
            assert!(limit == 81 || looks.contains(&limit));
        }
    }

    /// A value of which nothing is known was taken for one that is free of defects, or for one that has some.
    #[test]
    fn a_look_that_says_neither_ends_the_search_between_what_is_known() {
        let neither = Look::Unknown {
            unjudged: 1,
            failed: 0,
            of: 1,
        };
        let found = bisect(81, |index| {
            Ok::<Look, ()>(match index {
                0..=25 => Look::Free,
                26..=39 => neither,
                _ => Look::Defect,
            })
        });
        let between = Limit {
            free: 21,
            end: 40,
            unknown: Some((30, neither)),
        };
        assert_eq!(found, Ok(between));
    }

    #[test]
    fn the_values_are_those_of_a_sweep_and_those_of_the_speed_lie_5_rad_per_s_apart() {
        let range = |text| vec![Range::parse(text).unwrap()];
        let speeds = candidates("spindle.speed", &range("spindle.speed=100:500:2")).unwrap();
        assert_eq!((speeds.count, speeds.value(1)), (81, 105.0));
        let tensions = range("tensioner.tension=5:25:11");
        let tensions = candidates("tensioner.tension", &tensions).unwrap();
        // as many as a sweep takes
        assert_eq!((tensions.count, tensions.value(1)), (11, 7.0));
        let refused = candidates("spindle.speed", &range("tensioner.tension=5:25:10"));
        let told = refused.unwrap_err().to_string();
        assert!(told.contains("--over spindle.speed=A:B:N"), "{told}");
    }
}
