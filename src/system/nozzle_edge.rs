//! The edge at the nozzle and the node before it, whose length changes as wire comes and goes.

use super::System;
use crate::feed::LineYield;
use crate::rod::{Joint, Scalar};

impl System {
    /// Lets the edge at the nozzle grow by the unstretched length `grown` (m); returns the plastic
    /// stretch of the wire that passed. Call with the feed already advanced.
    ///
    /// Within the edge wire is alike: it takes the mean of what it was and of what came.
    pub(crate) fn pass_nozzle(&mut self, grown: f64) -> f64 {
        let state = &mut self.state;
        let last = state.rod.edges() - 1;
        let before = state.feed.map_or(0.0, |feed| feed.fed) - grown;
        let own = state.rod.stretch[last];
        let rest = state.rod.rest[last];
        state.rod.rest[last] = rest + grown;
        let passing = if grown <= 0.0 {
            state.line_wire.take_back(before, own);
            own.strain
        } else {
            let coming = state.line_wire.next(before);
            state.rod.stretch[last] = mixed(own, rest, coming, grown);
            coming.strain
        };
        if let (Some(spec), Some(feed)) = (&self.model.feed, &mut state.feed)
            && spec.has_spring()
        {
            feed.longer += state.line_wire.lengthens_by(passing) * grown;
        }
        passing
    }

    /// How the line's wire yields in the next step; nothing where the line is no spring.
    pub(crate) fn line_yield(&self) -> LineYield {
        match (&self.model.feed, &self.state.feed) {
            (Some(spec), Some(feed)) if spec.has_spring() => {
                let law = &self.model.laws.stretch;
                self.state.line_wire.yields(law, spec.line_length, feed.fed)
            }
            _ => LineYield::default(),
        }
    }

    /// Unstretched length that came into the edge at the nozzle, m, where the edge is `length` (m) long. Elastic wire would have
    /// grown by `grown`, m, and pull by `tension`, N, which rises by `slope`, N/m, with wire that came.
    ///
    /// Wire that yields to a tension is longer under it, so less of it came. A step takes the edge as elastic; taken over
    /// as it is, the edge would yield at its present length and pull less than the step has found.
    pub(crate) fn grown_with_yield(
        &self,
        length: f64,
        grown: f64,
        (tension, slope): (f64, f64),
    ) -> f64 {
        let rod = &self.state.rod;
        let last = rod.edges() - 1;
        let (rest, own) = (rod.rest[last], rod.stretch[last]);
        let law = &self.model.laws.stretch;
        let fed = self.state.feed.map_or(0.0, |feed| feed.fed);
        let coming = self.state.line_wire.next(fed);
        let mut found = grown;
        // (what came is a small part of the edge: its share is right to many digits at the second look)
        for _ in 0..3 {
            let edge = mixed(own, rest, coming, found);
            let pull = tension + slope * (found - grown);
            let over = pull - law.limit - edge.rise;
            if over <= 0.0 || law.hardening <= 0.0 {
                return found;
            }
            let stretch = 1.0 + edge.strain + over / law.hardening + pull / law.modulus;
            // Newton's method: less wire has to pull less, which a tensioner's mass makes steep in short steps
            let off = rest + found - length / stretch;
            let softer = 1.0 / law.hardening + 1.0 / law.modulus;
            found -= off / (1.0 + slope * softer * length / (stretch * stretch));
        }
        found
    }

    /// The wire in the line yields to the tension there at this instant.
    ///
    /// Of a line with mass it is the tension in its span, by which the step has let it get longer. By that at the nozzle
    /// the wire would yield to the same pull again in the next step.
    ///
    /// A step takes the edge at the nozzle as elastic, and so the line's tension where the edge then
    /// yields: the line pulls no harder than the edge does, but for friction at the exit. Wire that comes out yields to
    /// the tension behind that friction on its way.
    pub(crate) fn tighten_line_wire(&mut self) {
        let grip = self.exit_grip();
        let (Some(spec), Some(feed)) = (&self.model.feed, &self.state.feed) else {
            return;
        };
        let last = self.state.rod.edges() - 1;
        let edge = self.state.load.tension.get(last).copied().unwrap_or(0.0);
        let behind = if feed.rate > 0.0 {
            edge / grip
        } else {
            edge * grip
        };
        let tension = feed.line_tension.min(behind);
        let in_span = if spec.has_chain() {
            feed.span_tension
        } else {
            tension
        };
        let law = &self.model.laws.stretch;
        self.state
            .line_wire
            .pull(law, spec.line_length, feed.fed, in_span);
        let comes = feed.rate > 0.0;
        let after = if comes { tension * grip } else { 0.0 };
        self.state.line_wire.pull_at_exit(law, after);
    }

    /// The edge at the nozzle has grown by `grown`: it is straight wire that came or went, so the set
    /// at the node before stays, spread over the node's new length.
    pub(crate) fn keep_set_at_nozzle(&mut self, grown: f64) {
        let rod = &mut self.state.rod;
        let i = rod.nodes() - 2;
        let own = rod.voronoi(i);
        let scale = (own - 0.5 * grown) / own;
        rod.bend[i].curvature = rod.bend[i].curvature.map(|k| k * scale);
        rod.twist[i].strain *= scale;
    }

    /// Elastic energy per length of bending and twist at the node before the nozzle, J/m.
    pub(crate) fn bent_at_nozzle(&self) -> f64 {
        let rod = &self.state.rod;
        let i = rod.nodes() - 2;
        let joint = Joint::between(&rod.frame[i - 1], &rod.frame[i]);
        let own = rod.voronoi(i);
        let bent: f64 = (0..2)
            .map(|k| {
                0.5 * self.model.laws.bend.modulus
                    * (joint.bend[k] / own - rod.bend[i].curvature[k]).powi(2)
            })
            .sum();
        if self.model.twist.is_carried() {
            let twist = joint.twist / own - rod.twist[i].strain;
            return bent + 0.5 * self.model.laws.twist.modulus * twist * twist;
        }
        bent
    }
}

/// Plastic state of an edge of the unstretched length `rest` (m) into which `grown` (m) of wire came; none goes by going back.
fn mixed(own: Scalar, rest: f64, coming: Scalar, grown: f64) -> Scalar {
    if coming == own || grown <= 0.0 {
        return own;
    }
    let mean = |own: f64, coming: f64| (own * rest + coming * grown) / (rest + grown);
    Scalar {
        strain: mean(own.strain, coming.strain),
        rise: mean(own.rise, coming.rise),
    }
}
