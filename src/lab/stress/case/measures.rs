//! What a case took, and how near it came to its limits.

/// Numbers on the way of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// turned either way, turns
    pub turns: f64,
    /// simulated, s
    pub time: f64,
    /// communication steps
    pub looks: u64,
    /// wire fed, either way, m
    pub fed: f64,
    /// defects of the coil so far, as the output `defect_code` has them
    pub defects: i32,
    /// accepted steps
    pub steps: u64,
    /// steps thrown away
    pub rejects: u64,
    /// steps thrown away for a stalled Newton method
    pub newton_failures: u64,
    /// evaluations of the potential
    pub evaluations: u64,
    /// live nodes at most
    pub nodes: usize,
    /// node steps tried over those that are enough
    pub work: f64,
    /// unexplained energy over what went through, at worst
    pub energy: f64,
    /// plastic work, friction and damping, J
    pub dissipated: f64,
    /// what spindle and feed did, either way, J
    pub through: f64,
    /// motion energy at most, J
    pub motion: f64,
    /// what the time steps took out of the motion over what was dissipated, at the end
    pub numerical: f64,
    /// what changes of the mesh took over what was dissipated, at the end
    pub remeshing: f64,
    /// what blows or friction gave over plastic work and the work that draws in a diameter of wire, at worst
    pub given: f64,
    /// numerical energy and that of changes of the mesh over what is allowed, at worst
    pub own: [f64; 2],
    /// deepest contact as the method sees it, diameters
    pub depth: f64,
    /// deepest place of the centreline in the core, as measured beside it, diameters
    pub sunk: f64,
    /// deepest place in other wire, as measured beside the method, diameters
    pub crossed: f64,
    /// friction over its limit, at worst
    pub cone: f64,
    /// friction over its limit of wire on frozen wire and on live wire, at worst
    pub cone_on_wire: [f64; 2],
    /// plastic work by the hardening over what was booked, less one, at worst
    pub plastic: f64,
    /// compression of the wire at the nozzle over the tension that was set, at worst
    pub pushed: f64,
}

impl Measures {
    /// Steps tried.
    pub fn attempts(&self) -> u64 {
        self.steps + self.rejects + self.newton_failures
    }

    /// Names of [`Self::row`]'s columns.
    pub const COLUMNS: &'static str = "turns,time,looks,fed,defects,steps,rejects,newton_failures,evaluations,nodes,work,energy,dissipated,through,motion,numerical,remeshing,depth,sunk,crossed,cone,cone_on_frozen,cone_on_live,plastic,pushed,given,own_numerical,own_remeshing";

    /// The numbers, separated by commas.
    pub fn row(&self) -> String {
        let [frozen, live] = self.cone_on_wire;
        let counts = [
            self.steps,
            self.rejects,
            self.newton_failures,
            self.evaluations,
            self.nodes as u64,
        ]
        .map(|n| n.to_string());
        let rest = [
            self.work,
            self.energy,
            self.dissipated,
            self.through,
            self.motion,
            self.numerical,
            self.remeshing,
            self.depth,
            self.sunk,
            self.crossed,
            self.cone,
            frozen,
            live,
            self.plastic,
            self.pushed,
            self.given,
            self.own[0],
            self.own[1],
        ]
        .map(|x| format!("{x:.4e}"));
        let (turns, time, looks, fed) = (self.turns, self.time, self.looks, self.fed);
        format!(
            "{turns:.4},{time:.6e},{looks},{fed:.5e},{},{},{}",
            self.defects,
            counts.join(","),
            rest.join(",")
        )
    }
}
