//! `--find-max`: the highest value at which no member of the ensemble has a defect, by bisection.

use super::failure::Failure;
use super::sweep_range::Range;

/// Steps in which values of these variables are told: the spindle's is what a drive can be set to.
const STEPS: [(&str, f64); 2] = [
    ("spindle.speed", 5.0),
    ("spindle.speed_rpm", 5.0 * 30.0 / std::f64::consts::PI),
];

/// The values that bisection chooses from: A to B in steps of 5 rad/s for the spindle's speed, else in N parts.
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
    let step = step.map_or((range.to - range.from) / f64::from(range.count), |s| s.1);
    Ok(range.in_steps_of(step))
}

/// How many of the first `count` candidates are free of defects, where those above a limit have one and those below have none.
/// Each look winds an ensemble, so it takes as few as possible.
///
/// # Errors
/// Those of `is_free`.
pub(super) fn bisect<E>(
    count: usize,
    mut is_free: impl FnMut(usize) -> Result<bool, E>,
) -> Result<usize, E> {
    let (mut free, mut end) = (0, count);
    while free < end {
        let middle = free + (end - free) / 2;
        match is_free(middle)? {
            true => free = middle + 1,
            false => end = middle,
        }
    }
    Ok(free)
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
                Ok::<bool, ()>(index < limit)
            });
            assert_eq!(found, Ok(limit));
            assert!(looks.len() <= 7, "{limit}: {looks:?}");
            // What is told was wound: the last that is free and the first that is not.
            assert!(limit == 0 || looks.contains(&(limit - 1)));
            assert!(limit == 81 || looks.contains(&limit));
        }
    }

    #[test]
    fn the_speed_is_told_to_5_rad_per_s_and_others_to_a_part() {
        let range = |text| vec![Range::parse(text).unwrap()];
        let speeds = candidates("spindle.speed", &range("spindle.speed=100:500:2")).unwrap();
        assert_eq!((speeds.count, speeds.value(1)), (81, 105.0));
        let tensions = range("tensioner.tension=5:25:10");
        let tensions = candidates("tensioner.tension", &tensions).unwrap();
        assert_eq!((tensions.count, tensions.value(1)), (11, 7.0));
        let refused = candidates("spindle.speed", &range("tensioner.tension=5:25:10"));
        let told = refused.unwrap_err().to_string();
        assert!(told.contains("--over spindle.speed=A:B:N"), "{told}");
    }
}
