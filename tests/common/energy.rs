//! The energy balance of a run.

use roulement::simulation::outputs::Outputs;

/// [-] what a run left unaccounted for between two of its outputs, over what was put in or lost since its start.
pub fn open_share(before: &Outputs, after: &Outputs) -> f64 {
    let stored = after.stored_energy - before.stored_energy;
    let open = after.work - after.dissipated - stored;
    let share = open / after.work.abs().max(after.dissipated);
    println!("work {} J, lost {} J, stored {stored} J, open {share:e}", after.work, after.dissipated);
    share
}
