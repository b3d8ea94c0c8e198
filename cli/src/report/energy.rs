//! Does the energy of a run close, and if not, why?

use roulement::analysis::natural_frequency;
use roulement::scene::Level;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;

/// [-] what may be unaccounted for, over what was put in and taken out, or the losses
/// ([`Energies::turned_over`](roulement::model::energies::Energies::turned_over)).
pub const TOLERANCE: f64 = 1e-2;
/// [-] of the stored energy: less is rounding, where nearly nothing is put in or lost.
pub const ROUNDING: f64 = 1e-6;
/// [-] steps in a period of the highest natural frequency below which the scheme damps it.
const STEPS_A_PERIOD: f64 = 20.0;

/// Sums of a run that its energy balance needs.
#[derive(Clone, Debug, Default)]
pub struct EnergyWatch {
    stored_at_start: Option<f64>,
    begin: f64,
    /// \[N] largest loads on the inner and outer race.
    largest_load: [f64; 2],
    /// Which contacts were closed in the last row.
    closed: Vec<bool>,
    /// [-] contacts that opened or closed between rows.
    changes: u64,
}

impl EnergyWatch {
    /// Looks at a row.
    pub fn push(&mut self, outputs: &Outputs) {
        if self.stored_at_start.is_none() {
            (self.stored_at_start, self.begin) = (Some(outputs.stored_energy), outputs.time);
        }
        let loads = outputs.balls.iter().flat_map(|ball| [ball.inner.load, ball.outer.load]);
        let pockets = outputs.balls.iter().filter_map(|ball| ball.pocket.as_ref()).map(|pocket| pocket.load);
        let closed: Vec<bool> = loads.chain(pockets).map(|load| load > 0.0).collect();
        let changed = |(now, before): (&bool, &bool)| now != before;
        self.changes += closed.iter().zip(&self.closed).filter(|pair| changed(*pair)).count() as u64;
        self.closed = closed;
        for ball in &outputs.balls {
            self.largest_load[0] = self.largest_load[0].max(ball.inner.load);
            self.largest_load[1] = self.largest_load[1].max(ball.outer.load);
        }
    }

    /// \[s] time of the first row.
    pub fn begin(&self) -> f64 {
        self.begin
    }

    /// \[J] what was put in, by contacts whose stiffness changes too, less what was lost and what is stored since the start.
    pub fn balance(&self, now: &Outputs) -> f64 {
        let stored = now.stored_energy - self.stored_at_start.unwrap_or(now.stored_energy);
        now.work + now.stiffened - now.dissipated - stored
    }

    /// Warning where the energy does not close; none where it does.
    pub fn warning(&self, simulation: &Simulation) -> Option<String> {
        // Equilibria have no history that work could be done in.
        if simulation.scene().solver.level == Level::Equilibrium {
            return None;
        }
        let now = simulation.outputs();
        let (balance, turned_over) = (self.balance(now), simulation.state().energies.turned_over());
        if balance.abs() <= (TOLERANCE * turned_over).max(ROUNDING * now.stored_energy.abs()) {
            return None;
        }
        let (state, conditions) = (simulation.state(), simulation.conditions());
        let frequency = natural_frequency::of_ball(simulation.model(), state, &conditions, self.largest_load);
        let steps = state.statistics.steps.max(1) as f64;
        let step = (now.time - self.begin) / steps;
        let a_period = 1.0 / (frequency * step);
        let solver = &simulation.model().solver;
        let cause = if self.changes > 0 {
            format!(
                "impacts: contacts opened or closed {} times between rows, and a step across such a moment is less \
                 accurate; lower solver.tolerance = {:e} or solver.max_step = {:e} s",
                self.changes, solver.tolerance, solver.max_step.0
            )
        } else if a_period < STEPS_A_PERIOD {
            format!(
                "steps of {:.3e} s are long for the highest natural frequency, {:.1} kHz of a ball between its races: \
                 {a_period:.1} steps a period; lower solver.max_step = {:e} s",
                step,
                frequency * 1e-3,
                solver.max_step.0
            )
        } else {
            format!("the local error that solver.tolerance = {:e} allows; lower it", solver.tolerance)
        };
        let share = if turned_over > 0.0 {
            format!("{:.2} % of", 100.0 * balance / turned_over)
        } else {
            "no".into()
        };
        Some(format!(
            "energy does not close to 1 %: {balance:.3e} J, {share} what was put in, taken out or lost; likely {cause}"
        ))
    }
}
