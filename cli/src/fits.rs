//! What the tolerances of fits leave open: bearings of a machine with the least, the mean and the greatest interference of fits that are given by words.

use std::fmt;

use roulement::effects::growth::{Section, Within};
use roulement::scene::machine::MachineScene;
use serde_json::{Value, json};

use crate::duty::rated::{Rated, found, with_lives};
use crate::sweep::all::on_threads;

/// Ends of the tolerances and their mean, with their names.
pub const WITHIN: [(&str, Within); 3] =
    [("least", Within::Least), ("mean", Within::Mean), ("greatest", Within::Greatest)];

/// A bearing at one place within its tolerances.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Its name; that of a bearing alone is empty.
    pub bearing: String,
    /// Which place.
    pub within: &'static str,
    /// \[m] interference of the inner and the outer ring in operation, and clearance; negative ones are gaps and preload.
    pub dimensions: [f64; 3],
    /// Life, safety and losses.
    pub rated: Rated,
}

/// A report with what its fits leave open, `fits`, where they are given by words.
pub fn with_fits(mut report: Value, fits: Option<&Fits>) -> Value {
    if let Some(fits) = fits {
        report["fits"] = fits.to_json();
    }
    report
}

/// All bearings that have such fits.
#[derive(Clone, Debug)]
pub struct Fits(Vec<Fitted>);

/// Does a section have a fit by words?
pub fn by_words(section: &Section) -> bool {
    [&section.shaft, &section.housing].into_iter().flatten().any(|seat| seat.fit.is_some())
}

/// Does any bearing of a machine have a fit by words?
pub fn are_of(scene: &MachineScene) -> bool {
    scene.bearings().iter().any(|(_, of)| of.effects.growth.section.as_ref().is_some_and(by_words))
}

/// The machine with all such fits at one place within their tolerances.
pub fn at(scene: &MachineScene, within: Within) -> MachineScene {
    let mut scene = scene.clone();
    let sections = scene.bearings_mut().filter_map(|bearing| bearing.effects.growth.section.as_mut());
    sections.for_each(|section| section.fits = within);
    scene
}

impl Fits {
    /// Looks at a machine where its run begins; none without such a fit.
    ///
    /// # Errors
    /// If there is no equilibrium; names the place within the tolerances.
    pub fn of(scene: &MachineScene, threads: usize) -> Result<Option<Self>, String> {
        if !are_of(scene) {
            return Ok(None);
        }
        let look = |index: usize| {
            let (name, within) = WITHIN[index];
            let failed = |why| format!("fits at their {name}: {why}");
            let (scene, machine) = with_lives(at(scene, within)).map_err(failed)?;
            let rated = found(&scene, &machine, 1.0);
            let fitted = machine.bearings().filter_map(|(own, bearing)| {
                let growth = bearing.outputs().growth?;
                let (_, rated) = rated.iter().find(|(name, _)| name == own)?;
                let [inner, outer] = growth.interference;
                Some(Fitted {
                    bearing: own.to_owned(),
                    within: name,
                    dimensions: [inner, outer, growth.clearance],
                    rated: rated.clone(),
                })
            });
            Ok(fitted.collect::<Vec<_>>())
        };
        let all = on_threads(WITHIN.len(), threads, look).into_iter().collect::<Result<Vec<_>, String>>()?;
        Ok(Some(Self(all.concat())))
    }

    /// A list with `bearing`, `fits`, `interference` of both rings and `clearance` \[m], life \[h], `static_safety`, `friction_torque` [N m] and
    /// `loss` \[W].
    pub fn to_json(&self) -> Value {
        let of = |Fitted { bearing, within, dimensions: [inner, outer, clearance], rated }: &Fitted| {
            json!({
                "bearing": bearing,
                "fits": within,
                "interference": { "inner": inner, "outer": outer },
                "clearance": clearance,
                "L10r_hours": rated.hours()[0],
                "modified_hours": rated.hours()[1],
                "static_safety": rated.safety,
                "friction_torque": rated.torque,
                "loss": rated.loss,
            })
        };
        self.0.iter().map(of).collect()
    }
}

impl fmt::Display for Fits {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "fits             within their tolerances, where a run begins")?;
        for Fitted { bearing, within, dimensions, rated } in &self.0 {
            let [inner, outer, clearance] = dimensions.map(|length| 1e6 * length);
            let who = if bearing.is_empty() { String::new() } else { format!("{bearing}: ") };
            write!(
                out,
                "  {:<15}interference {inner:.1} um on the shaft, {outer:.1} um in the housing, clearance {clearance:.1} um",
                format!("{who}{within}")
            )?;
            if let Some(hours) = rated.hours()[0] {
                write!(out, ", L10r {hours:.0} h")?;
            }
            write!(out, ", static safety {:.2}", rated.safety)?;
            if let Some(torque) = rated.torque {
                write!(out, ", torque {:.1} N mm", 1e3 * torque)?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}
