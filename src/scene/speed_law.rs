//! How fast the spindle turns at every angle that it has turned, as stretches of constant acceleration.

use std::sync::Arc;

/// A stretch of constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// angle turned at its start, rad
    pub from: f64,
    /// angle turned in it, rad; the last goes on without end
    pub turned: f64,
    /// time at its start, s
    pub start: f64,
    /// its time, s; the last goes on without end
    pub duration: f64,
    /// speed at its start, rad/s
    pub speed: f64,
    /// speed gained in it, rad/s
    pub gain: f64,
}

/// Speed over the angle that the spindle has turned, whichever way round. It is above zero but where it begins from rest.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedLaw {
    /// by rising angle, the first from 0
    stretches: Arc<[Stretch]>,
}

impl Stretch {
    /// Speed so long after its start, s, in rad/s.
    fn speed(&self, time: f64) -> f64 {
        match self.duration.is_finite() {
            true => self.speed + self.gain * time / self.duration,
            false => self.speed,
        }
    }

    /// Angle turned so long after its start, s, in rad.
    fn angle(&self, time: f64) -> f64 {
        if !self.duration.is_finite() {
            return self.speed * time;
        }
        let share = time / self.duration;
        let even = self.speed * self.duration;
        even * share + (self.turned - even) * (share * share)
    }

    /// Time in which it turns by this angle, rad, in s.
    fn time(&self, angle: f64) -> f64 {
        if !self.duration.is_finite() {
            return angle / self.speed;
        }
        let even = self.speed * self.duration;
        let rise = self.turned - even;
        let share = match even {
            0.0 => (angle / rise).sqrt(),
            _ => 2.0 * angle / (even + (even * even + 4.0 * rise * angle).max(0.0).sqrt()),
        };
        self.duration * share
    }
}

impl SpeedLaw {
    /// Constant acceleration between points: angle, rad, and square of the speed, (rad/s)^2. Angles rise from 0; no speed but the
    /// first is 0. The last speed goes on.
    pub(super) fn through(points: &[[f64; 2]]) -> Self {
        let mut stretches = Vec::with_capacity(points.len());
        let mut start = 0.0;
        for pair in points.windows(2) {
            let [[from, before], [to, after]] = [pair[0], pair[1]];
            let (turned, speed, end) = (to - from, before.sqrt(), after.sqrt());
            let duration = 2.0 * turned / (speed + end);
            stretches.push(Stretch {
                from,
                turned,
                start,
                duration,
                speed,
                gain: end - speed,
            });
            start += duration;
        }
        let last = points[points.len() - 1];
        stretches.push(Stretch {
            from: last[0],
            turned: f64::INFINITY,
            start,
            duration: f64::INFINITY,
            speed: last[1].sqrt(),
            gain: 0.0,
        });
        Self {
            stretches: stretches.into(),
        }
    }

    /// Its stretches by rising angle.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    fn at_time(&self, time: f64) -> &Stretch {
        let next = self.stretches.partition_point(|one| one.start <= time);
        &self.stretches[next.max(1) - 1]
    }

    /// Angle turned at a time, s, in rad.
    pub fn angle(&self, time: f64) -> f64 {
        let stretch = self.at_time(time);
        stretch.from + stretch.angle(time - stretch.start)
    }

    /// Speed at a time, s, in rad/s.
    pub fn speed(&self, time: f64) -> f64 {
        let stretch = self.at_time(time);
        stretch.speed(time - stretch.start)
    }

    /// Time at which this angle, rad, has been turned, s.
    pub fn time_at(&self, angle: f64) -> f64 {
        let next = self.stretches.partition_point(|one| one.from <= angle);
        let stretch = &self.stretches[next.max(1) - 1];
        stretch.start + stretch.time(angle - stretch.from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From rest to 100 rad/s in 3 rad, as long at it, down to 40 rad/s in 1 rad, and on.
    fn law() -> SpeedLaw {
        SpeedLaw::through(&[[0.0, 0.0], [3.0, 1e4], [6.0, 1e4], [7.0, 1600.0]])
    }

    #[test]
    fn times_and_angles_undo_each_other() {
        let law = law();
        for k in 0..=100 {
            let angle = 0.1 * f64::from(k);
            let back = law.angle(law.time_at(angle));
            assert!((back - angle).abs() < 1e-12, "{angle}: {back}");
        }
    }

    #[test]
    fn the_speed_is_how_the_angle_changes_and_has_no_jumps() {
        let law = law();
        let end = law.time_at(9.0);
        for k in 1..1000 {
            let time = end * f64::from(k) / 1000.0;
            let h = 1e-9;
            let slope = (law.angle(time + h) - law.angle(time - h)) / (2.0 * h);
            assert!((slope - law.speed(time)).abs() < 1e-3, "{time}");
        }
        assert_eq!(
            [0.0, 3.0, 5.0, 7.0, 9.0].map(|a| law.speed(law.time_at(a)).round()),
            [0.0, 100.0, 100.0, 40.0, 40.0]
        );
        // v^2 = v0^2 + 2 a s
        let middle = law.speed(law.time_at(6.5));
        assert!((middle * middle - 0.5 * (1e4 + 1600.0)).abs() < 1e-6);
    }
}
