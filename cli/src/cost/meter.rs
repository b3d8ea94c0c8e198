//! CPU time and instructions of a stretch of this thread's work.

use crate::clock::ThreadTime;

/// Cost of a stretch of work.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// \[s] CPU time of this thread.
    pub cpu: f64,
    /// Instructions in user mode, where the machine counts them and lets us read it.
    pub instructions: Option<f64>,
}

/// A running measurement.
pub struct Meter {
    begin: ThreadTime,
    #[cfg(target_os = "linux")]
    counter: Option<perf_event::Counter>,
}

impl Meter {
    /// Begins to measure.
    pub fn start() -> Self {
        Self {
            #[cfg(target_os = "linux")]
            counter: instruction_counter(),
            begin: ThreadTime::now(),
        }
    }

    /// Ends the measurement.
    #[cfg_attr(not(target_os = "linux"), allow(unused_mut))]
    pub fn stop(mut self) -> Cost {
        let cpu = self.begin.elapsed().as_secs_f64();
        #[cfg(target_os = "linux")]
        let instructions = self.counter.as_mut().and_then(|counter| Some(counter.read().ok()? as f64));
        #[cfg(not(target_os = "linux"))]
        let instructions = None;
        Cost { cpu, instructions }
    }
}

/// None without a counter in hardware, as in most virtual machines, or without the permission to use it.
#[cfg(target_os = "linux")]
fn instruction_counter() -> Option<perf_event::Counter> {
    let mut counter =
        perf_event::Builder::new().kind(perf_event::events::Hardware::INSTRUCTIONS).build().ok()?;
    counter.enable().ok()?;
    Some(counter)
}
