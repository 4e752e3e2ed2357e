//! How a trail of single steps is kept (feature `lab`).

use crate::integrate::SolverStatistics;
use crate::rod::Rod;
use crate::simulation::{StepTrail, Winding};

/// What is known before a step.
pub(super) struct Before {
    rises: [Vec<f64>; 3],
    statistics: SolverStatistics,
}

fn rises(rod: &Rod) -> [Vec<f64>; 3] {
    [
        rod.bend.iter().map(|b| b.rise).collect(),
        rod.twist.iter().map(|t| t.rise).collect(),
        rod.stretch.iter().map(|s| s.rise).collect(),
    ]
}

impl Winding {
    /// To be called before a step; none where nobody asked.
    pub(super) fn begin_trail(&self) -> Option<Before> {
        self.trail.is_some().then(|| Before {
            rises: rises(&self.sys.state.rod),
            statistics: self.statistics(),
        })
    }

    /// To be called after the method's step, before remeshing.
    pub(super) fn end_trail(&mut self, before: Option<Before>) {
        let (Some(before), Some(_)) = (before, &self.trail) else {
            return;
        };
        let (now, was) = (self.statistics(), before.statistics);
        let after = rises(&self.sys.state.rod);
        let yielding = std::array::from_fn(|kind| {
            let both = before.rises[kind].iter().zip(&after[kind]);
            let rose = both.enumerate().filter(|(_, (old, new))| old != new);
            rose.map(|(place, _)| place).collect()
        });
        let (mut touching, mut sliding) = (Vec::new(), Vec::new());
        if let Some(line) = self.sys.state.contact.as_line() {
            for (mark, slides) in line.marks() {
                touching.push(mark);
                if slides {
                    sliding.push(mark);
                }
            }
        }
        let step = StepTrail {
            touching,
            sliding,
            yielding,
            nodes: self.sys.state.rod.nodes(),
            taken: SolverStatistics {
                steps: now.steps - was.steps,
                rejects: now.rejects - was.rejects,
                newton_failures: now.newton_failures - was.newton_failures,
                forced: now.forced - was.forced,
                solves: now.solves - was.solves,
                evaluations: now.evaluations - was.evaluations,
                line_search_halvings: now.line_search_halvings - was.line_search_halvings,
                cg_iterations: now.cg_iterations - was.cg_iterations,
            },
        };
        self.trail.get_or_insert_default().push(step);
    }
}
