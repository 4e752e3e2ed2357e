//! What `--over NAME=A:B:N` says: N values of a variable, evenly from A to B.

use super::members::rounded;
use coilwind::scene::unit_suffixes;
use coilwind::variables::{Variable, by_name, table};
use std::fmt;

/// Most values of a range: more is a slip of the keyboard.
const MOST: u32 = 100_000;
/// Digits of the values between the ends: 0.3, not 0.30000000000000004.
const DIGITS: usize = 12;
/// What the argument has to look like.
const FORM: &str = "expected NAME=A:B:N, such as spindle.speed=100:400:4";

/// Values of one variable, in the unit of its name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) name: String,
    pub(super) from: f64,
    pub(super) to: f64,
    /// how many, the ends among them
    pub(super) count: u32,
}

impl Range {
    /// Reads `NAME=A:B:N`; tells what is wrong with it, and what would do.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let (name, range) = text.split_once('=').ok_or(FORM)?;
        let name = name.trim();
        let [from, to, count] = range.split(':').collect::<Vec<_>>()[..] else {
            return Err(FORM.to_owned());
        };
        if name.is_empty() {
            return Err(FORM.to_owned());
        }
        let number = |what: &str, text: &str| match text.trim().parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(format!("{name}: {what} = {text}; allowed: a finite number")),
        };
        let (from, to) = (number("A", from)?, number("B", to)?);
        let count = match count.trim().parse::<u32>() {
            Ok(n) if (1..=MOST).contains(&n) => n,
            _ => {
                return Err(format!(
                    "{name}: N = {count}; allowed: a whole number from 1 to {MOST}"
                ));
            }
        };
        if from > to {
            return Err(format!(
                "{name}: the range from {from} to {to} is reversed; allowed: A below B, here {name}={to}:{from}:{count}"
            ));
        }
        if from == to && count > 1 {
            return Err(format!(
                "{name}: the range from {from} to {to} is empty; allowed: A below B, or N = 1"
            ));
        }
        if from < to && count == 1 {
            return Err(format!(
                "{name}: N = 1 is one value and {from} to {to} are two; allowed: A = B, or N from 2 to {MOST}"
            ));
        }
        Ok(Self {
            name: name.to_owned(),
            from,
            to,
            count,
        })
    }

    /// The variable that the name means, in whatever unit: `spindle.speed` of `spindle.speed_rpm`.
    pub(super) fn variable(&self) -> &str {
        variable_of(&self.name)
    }

    /// The unit of its values; empty where the name carries it.
    pub(super) fn unit(&self) -> &'static str {
        by_name(&self.name).map_or("", |variable| variable.unit)
    }

    /// What its axis is called: the name, with the unit where the name does not carry it.
    pub(super) fn title(&self) -> String {
        match self.unit() {
            "" | "1" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }

    /// The same range with more values between its own, so that neighbours lie at most `step` apart.
    pub(super) fn refined_to(&self, step: f64) -> Self {
        let parts = self.count.saturating_sub(1).max(1);
        let length = (self.to - self.from) / f64::from(parts);
        // A part of whole steps keeps their number in spite of rounding.
        let steps = (length / step - 1e-9).ceil().max(1.0);
        let most = f64::from((MOST - 1) / parts).max(1.0);
        Self {
            count: parts * steps.min(most) as u32 + 1,
            ..self.clone()
        }
    }

    /// Value `index`, from 0.
    pub(super) fn value(&self, index: u32) -> f64 {
        if index == 0 {
            return self.from;
        }
        if index + 1 == self.count {
            return self.to;
        }
        let share = f64::from(index) / f64::from(self.count - 1);
        rounded(self.from + share * (self.to - self.from), DIGITS)
    }
}

/// The variable that a name with or without a unit means; the name itself where there is none.
pub(super) fn variable_of(name: &str) -> &str {
    let means = |v: &&Variable| {
        let unit = name
            .strip_prefix(v.name)
            .and_then(|rest| rest.strip_prefix('_'));
        v.name == name || unit.is_some_and(|unit| unit_suffixes(v).contains(&unit))
    };
    table().iter().find(means).map_or(name, |v| v.name)
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}:{}:{}", self.name, self.from, self.to, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_that_people_write() {
        let range = Range::parse("x=0.1:0.7:7").unwrap();
        let values: Vec<f64> = (0..7).map(|k| range.value(k)).collect();
        assert_eq!(values, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
        assert_eq!(range.to_string(), "x=0.1:0.7:7");
    }

    #[test]
    fn an_axis_says_in_what_unit_its_values_are() {
        for (range, title) in [
            ("spindle.speed=1:2:2", "spindle.speed [rad/s]"),
            ("spindle.speed_rpm=1:2:2", "spindle.speed_rpm"),
            ("friction.static=0.1:0.2:2", "friction.static"),
            ("winding.layers=1:2:2", "winding.layers"),
        ] {
            assert_eq!(Range::parse(range).unwrap().title(), title);
        }
    }

    #[test]
    fn a_refined_range_keeps_its_values_and_has_no_longer_steps_than_asked_for() {
        let range = |text| Range::parse(text).unwrap();
        for (text, step, count) in [
            ("x=100:500:2", 5.0, 81),
            ("x=100:500:2", 300.0, 3),
            ("x=100:500:2", 1e9, 2),
            ("x=100:500:401", 5.0, 401),
            ("x=100:112:3", 5.0, 5),
            ("x=0:1e9:2", 1e-3, 100_000),
        ] {
            let (asked, refined) = (range(text), range(text).refined_to(step));
            assert_eq!(refined.count, count, "{text} in steps of {step}");
            let values: Vec<f64> = (0..refined.count).map(|k| refined.value(k)).collect();
            assert!(
                (0..asked.count).all(|k| values.contains(&asked.value(k))),
                "{text}"
            );
        }
    }

    #[test]
    fn what_is_no_range_is_told() {
        for (text, part) in [
            ("x", "NAME=A:B:N"),
            ("=1:2:3", "NAME=A:B:N"),
            ("x=1:2", "NAME=A:B:N"),
            ("x=a:2:3", "A = a"),
            ("x=1:inf:3", "B = inf"),
            ("x=1:2:0", "N = 0"),
            ("x=1:2:2.5", "N = 2.5"),
            ("x=2:1:3", "reversed; allowed: A below B, here x=1:2:3"),
            ("x=2:2:3", "empty"),
            ("x=1:2:1", "A = B, or N from 2"),
        ] {
            let told = Range::parse(text).unwrap_err();
            assert!(told.contains(part), "{text}: {told}");
        }
    }
}
