//! The handle of a run: its winding, the step ahead of it, and what was said at communication points.

use super::ahead::Ahead;
use super::pool::Pool;
use super::talk::Talk;
use crate::scene::Scene;
use crate::signals::{Event, Inputs, Outputs};
use crate::simulation::motion::{MasterInputs, check_finite, with_brake};
use crate::simulation::{SimError, Winding};
#[cfg(feature = "lab")]
use crate::system::System;
use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A winding run, from one communication point to the next. A copy shares what neither has changed since.
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(in crate::simulation) now: Arc<Winding>,
    pub(in crate::simulation) ahead: Option<Ahead>,
    pub(in crate::simulation) talk: Talk,
    pub(in crate::simulation) pool: Pool,
    pub(in crate::simulation) steps_beyond: bool,
}

/// A run is read as its winding is; what a communication point has of its own, time, inputs and outputs, comes first.
impl Deref for Simulation {
    type Target = Winding;

    fn deref(&self) -> &Winding {
        &self.now
    }
}

impl From<Winding> for Simulation {
    fn from(mut winding: Winding) -> Self {
        let mut talk = Talk::default();
        talk.events.append(&mut winding.run.events);
        Self {
            now: Arc::new(winding),
            ahead: None,
            talk,
            pool: Pool::default(),
            steps_beyond: false,
        }
    }
}

impl Simulation {
    /// Wire clamped to the core and straight to the nozzle at the set tension, everything at rest.
    ///
    /// # Errors
    ///
    /// If the scene has no valid start.
    pub fn new(scene: &Scene) -> Result<Self, SimError> {
        Winding::new(scene).map(Self::from)
    }

    /// The same with these inputs at the start.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn starting_with(scene: &Scene, inputs: Inputs) -> Result<Self, SimError> {
        check_finite(&inputs, 0.0)?;
        Winding::starting_with(scene, with_brake(scene, inputs))
            .map(|run| Self::started(run, inputs))
    }

    /// Starts a run whose nozzle follows [`Scene::nozzle_law`]; `nozzle_position` is not looked at in such a run.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn starting_by_law(scene: &Scene, inputs: Inputs) -> Result<Self, SimError> {
        check_finite(&inputs, 0.0)?;
        Winding::starting_by_law(scene, with_brake(scene, inputs))
            .map(|run| Self::started(run, inputs))
    }

    fn started(winding: Winding, inputs: Inputs) -> Self {
        let mut run = Self::from(winding);
        run.talk.given = Some(MasterInputs::new(inputs, &Inputs::HELD, 0.0));
        run
    }

    /// Starts over with other inputs; only before the first step.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn set_start(&mut self, inputs: Inputs) -> Result<(), SimError> {
        let run = match self.nozzle_follows_law() {
            true => Self::starting_by_law(self.scene(), inputs)?,
            false => Self::starting_with(self.scene(), inputs)?,
        };
        *self = Self {
            steps_beyond: self.steps_beyond,
            ..run
        };
        Ok(())
    }

    /// Lets steps of the implicit method reach beyond the communication point, as long as inputs go on as they did. Then a fine
    /// communication step costs little, and the coil may be a step of the method behind; see [`Self::catch_up`].
    pub fn step_beyond(&mut self, on: bool) {
        self.steps_beyond = on;
    }

    /// Bounds the work of the run: beyond `most`, [`Self::advance`] returns an error.
    ///
    /// The work is the number of steps tried since the start, each times its number of nodes.
    /// Rejected steps count too. The bound does not depend on the clock.
    pub fn limit_work(&mut self, most: u64) {
        self.for_all_steps(|winding| winding.most_work = most);
    }

    /// Lets a step of the run end early, with an error, once `flag` is up, however long the step is. The run then stands at the
    /// last good step of the method.
    pub fn stop_on(&mut self, flag: Arc<AtomicBool>) {
        self.for_all_steps(|winding| winding.stop = Some(Arc::clone(&flag)));
    }

    /// Changes what bounds the steps to come: the winding that has taken a step ahead takes the next ones too.
    fn for_all_steps(&mut self, change: impl Fn(&mut Winding)) {
        let ahead = self.ahead.as_mut().map(|ahead| &mut ahead.winding);
        for winding in std::iter::once(&mut self.now).chain(ahead) {
            change(Arc::make_mut(winding));
        }
    }

    /// Time of the communication point, s.
    pub fn time(&self) -> f64 {
        let served = self.talk.served.as_ref();
        served.map_or(self.now.run.time, |served| served.time)
    }

    /// Input values at the communication point.
    pub fn inputs(&self) -> Inputs {
        let served = self.talk.served.as_ref();
        let inputs = served.map_or_else(|| self.now.inputs(), |served| served.inputs);
        match &self.talk.given {
            Some(given) => given.pull_of(inputs),
            None => inputs,
        }
    }

    /// Outputs at the communication point.
    pub fn outputs(&self) -> &Outputs {
        let served = self.talk.served.as_ref();
        served.map_or(&self.now.run.outputs, |served| &served.outputs)
    }

    /// Returns the first time derivatives of the outputs at the last communication point, per s.
    ///
    /// - `spindle_angle`, `fed_length` and `tensioner_position`: the speeds themselves.
    /// - `nozzle_y`: the mean speed over the communication step.
    /// - `free_length`: the change over the communication step; 0 where a stretch of wire landed in it.
    /// - `layon_*`, `turns_wound`: 0. Wire swings about a corner and lands on the next, so that these go in jumps.
    /// - `wire_tension`, `spindle_torque`, `feed_speed`: 0. The free span rings at a period of a millisecond, so that
    ///   a slope of now misses the next communication point by more than the value held.
    /// - All others: 0, because they change only when wire comes to rest.
    pub fn output_rates(&self) -> &Outputs {
        self.talk
            .served
            .as_ref()
            .map_or(&self.now.run.rates, |served| &served.rates)
    }

    /// Wire, coil and method at the end of the last step that does not reach beyond the communication point.
    pub fn winding(&self) -> &Winding {
        &self.now
    }

    /// What happened since the last call.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.talk.events)
    }

    /// Takes over the tunable parameters of another version of the scene.
    ///
    /// # Errors
    ///
    /// If the method gives up on the way to the communication point, from which on they hold.
    pub fn retune(&mut self, scene: &Scene) -> Result<(), SimError> {
        self.catch_up()?;
        let winding = Arc::make_mut(&mut self.now);
        winding.run.events.clear();
        winding.retune(scene);
        self.talk.events.append(&mut winding.run.events);
        self.pool = Pool::default();
        Ok(())
    }

    /// The mechanical system, to put loads on it that no scene has (verification only).
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn system_mut(&mut self) -> &mut System {
        &mut Arc::make_mut(&mut self.now).sys
    }

    /// Begins a trail of the steps from here on; a copy of the run takes it along.
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn begin_trail(&mut self) {
        Arc::make_mut(&mut self.now).trail = Some(Vec::new());
    }

    /// The steps since [`Self::begin_trail`].
    #[cfg(feature = "lab")]
    #[doc(hidden)]
    pub fn trail(&self) -> &[crate::simulation::StepTrail] {
        self.now.trail.as_deref().unwrap_or_default()
    }
}
