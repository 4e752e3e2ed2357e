//! The largest of many unknowns.

/// Size of the largest of the unknowns `all`, m, and the number of the first one so large; a roll counts at this `radius`, m, and
/// what is no number as infinite.
///
/// Node by node, with no question but whether it holds the largest so far. That leaves out what is no number, which the sum of
/// all tells.
pub(super) fn largest<const D: usize>(all: &[f64], radius: f64) -> (f64, usize) {
    let nodes = all.as_chunks::<D>().0;
    let (mut most, mut at, mut sum) = (0.0, 0, 0.0);
    for (node, u) in nodes.iter().enumerate() {
        let mut here = 0.0;
        for a in 0..D {
            let size = size(a, u[a], radius);
            here = if size > here { size } else { here };
            sum += u[a];
        }
        if here > most {
            (most, at) = (here, node);
        }
    }
    if !f64::is_finite(sum) {
        return one_by_one::<D>(all, radius);
    }
    let found = (0..D).find(|&a| nodes.get(at).is_some_and(|u| size(a, u[a], radius) == most));
    (most, D * at + found.unwrap_or(0))
}

/// Size of unknown `a` of a node, m.
#[inline(always)]
fn size(a: usize, u: f64, radius: f64) -> f64 {
    if a < 3 { u.abs() } else { u.abs() * radius }
}

/// The slow twin of [`largest`], which looks at one unknown after the other.
#[cold]
fn one_by_one<const D: usize>(all: &[f64], radius: f64) -> (f64, usize) {
    let (mut most, mut at) = (0.0, 0);
    for (k, u) in all.iter().enumerate() {
        let size = size(k % D, *u, radius);
        let size = if size.is_nan() { f64::INFINITY } else { size };
        if size > most {
            (most, at) = (size, k);
        }
    }
    (most, at)
}

#[cfg(test)]
mod tests {
    use super::{largest, one_by_one};

    fn agrees<const D: usize>(all: &[f64]) {
        assert_eq!(largest::<D>(all, 0.5), one_by_one::<D>(all, 0.5), "{all:?}");
    }

    #[test]
    fn it_is_the_first_of_the_largest() {
        let some: Vec<f64> = (0..24)
            .map(|k| f64::from((k * 37 + 11) % 23 - 11))
            .collect();
        for at in 0..24 {
            for x in [0.0, 1.0, -11.0, 30.0, f64::NAN, f64::NEG_INFINITY] {
                let mut all = some.clone();
                all[at] = x;
                agrees::<3>(&all);
                agrees::<4>(&all);
                all[23 - at] = x;
                agrees::<3>(&all);
                agrees::<4>(&all);
            }
        }
        agrees::<3>(&[0.0; 12]);
        agrees::<4>(&[]);
    }
}
