//! The loads of a duty: those of a table, or the `[[duty]]` of a scene.

use std::path::Path;

use roulement::scene::DutySection;
use roulement::scene::machine::MachineScene;

use super::DutyError;
use crate::sweep::cases::Cases;

/// Column of the shares of the time.
const SHARE: &str = "share";
/// [-] difference of the sum of the shares from 1 from which on it is told: they are rounded to two digits.
const ROUNDED: f64 = 0.011;

/// A load of the duty.
pub struct Load {
    /// Its name, or the number of its row.
    pub name: String,
    /// Its part of the whole, in whatever unit that has.
    pub part: f64,
    /// The scene under it.
    pub scene: MachineScene,
}

/// All loads.
pub struct Duty {
    /// The loads.
    pub loads: Vec<Load>,
    /// Where they are from, before the name of one of them.
    pub from: String,
    /// Are their parts hours?
    pub by_hours: bool,
}

impl Duty {
    /// Loads of a table.
    ///
    /// # Errors
    /// If it cannot be read or a load is refused; names it.
    pub fn of_table(path: &Path, base: &MachineScene) -> Result<Self, DutyError> {
        let mut cases = Cases::load(path)?;
        let file = path.display();
        let column = cases.keys.iter().position(|key| key.name == SHARE);
        let Some(column) = column else {
            return Err(DutyError::Load(format!(
                "{file}: a column `{SHARE}` is missing: the share of the time that a load has"
            )));
        };
        let shares = cases.rows.iter().enumerate().map(|(row, cells)| {
            let share =
                cells.get(column).and_then(|cell| cell.as_ref()).map_or("", |cell| cell.shown.as_str());
            let wrong =
                || format!("{file}, load {}: {SHARE} = {share} is out of range: a number above 0", row + 1);
            share.parse().ok().filter(|share| f64::is_finite(*share) && *share > 0.0).ok_or_else(wrong)
        });
        let shares = shares.collect::<Result<Vec<f64>, _>>().map_err(DutyError::Load)?;
        // All other columns are keys of the scene.
        cases.keys.remove(column);
        cases.rows.iter_mut().filter(|row| row.len() > column).for_each(|row| {
            row.remove(column);
        });
        let from = format!("{file}, load ");
        let scene =
            |row: usize| cases.text_of(base.source(), row).and_then(|text| MachineScene::edited(&text));
        let load = |(row, part): (usize, &f64)| {
            let scene = scene(row).map_err(|why| DutyError::Load(format!("{from}{}: {why}", row + 1)))?;
            Ok(Load { name: (row + 1).to_string(), part: *part, scene })
        };
        let loads = shares.iter().enumerate().map(load).collect::<Result<_, DutyError>>()?;
        Ok(Self { loads, from, by_hours: false })
    }

    /// Loads of the scene itself.
    ///
    /// # Errors
    /// If there are none or one is refused; names it.
    pub fn of_scene(base: &MachineScene) -> Result<Self, DutyError> {
        let duty = base.duty();
        let by_hours = duty.first().ok_or(DutyError::NoLoads)?.hours.is_some();
        let from = "duty ".to_string();
        let load = |of: &DutySection| {
            let scene = base.under(of).map_err(|why| DutyError::Load(format!("{from}{}: {why}", of.name)))?;
            Ok(Load { name: of.name.clone(), part: of.part(), scene })
        };
        let loads = duty.iter().map(load).collect::<Result<_, DutyError>>()?;
        Ok(Self { loads, from, by_hours })
    }

    /// The same with other scenes.
    #[must_use]
    pub fn with(&self, of: impl Fn(&MachineScene) -> MachineScene) -> Self {
        let loads = self.loads.iter().map(|load| Load {
            name: load.name.clone(),
            part: load.part,
            scene: of(&load.scene),
        });
        Self { loads: loads.collect(), from: self.from.clone(), by_hours: self.by_hours }
    }

    /// What its reader should know of the shares.
    pub fn note(&self) -> Option<String> {
        let whole: f64 = self.loads.iter().map(|load| load.part).sum();
        let odd = !self.by_hours && (whole - 1.0).abs() > ROUNDED;
        odd.then(|| format!("note: the shares come to {whole}; each is taken of that"))
    }
}
