//! The paper's own switch of creep laws inside Newton's method (its section 3.1.3), as an experiment beside ours: no scene asks
//! for it. `docs/creep-laws.md` has what it gave.
//!
//! An iteration begins with the regularised law. Once the residual is small it goes on with Kalker's nonlinear theory in
//! polynomials, solved anew in every evaluation of every contact, from the solution of the last accepted step. The law `kalker` of scenes freezes what the polynomials
//! add to a smooth table for each step instead ([`crate::contact::creep::Law::Frozen`]).

use super::bodies::{PerRace, Race};
use super::raceways::RacewayContacts;
use super::{Conditions, Model};
use crate::contact::ContactModel;
use crate::kalker::nonlinear::KalkerError;
use crate::scene::{CreepLaw, Scene};

/// What an iteration begins with.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Balls against raceways with the regularised law.
    raceways: PerRace<RacewayContacts>,
    /// \[N] residual below which the law of the model itself takes over.
    residual: f64,
}

impl Model {
    /// The model of a scene whose iterations switch from the law `regularised` to polynomials at a residual \[N]. The scene's own law is
    /// not asked; its `kalker_degree` and the slip of its grooves are.
    ///
    /// # Errors
    /// If creep coefficients cannot be computed for the bearing's contacts.
    pub fn switching(scene: &Scene, residual: f64) -> Result<Self, KalkerError> {
        let with = |law: CreepLaw| {
            let mut scene = scene.clone();
            scene.effects.creep.law = law;
            Self::new(&scene)
        };
        let [first, mut model] = [with(CreepLaw::Regularised)?, with(CreepLaw::Kalker)?];
        let PerRace { inner, outer } = model.raceways;
        model.raceways = PerRace { inner: inner.unfrozen(), outer: outer.unfrozen() };
        model.switch = Some(Switch { raceways: first.raceways, residual });
        Ok(model)
    }

    /// What an iteration begins with, and down to which residual \[N]; none but in the experiment.
    pub(crate) fn first_law(&self, conditions: &Conditions) -> Option<(PerRace<ContactModel<'_>>, f64)> {
        let switch = self.switch.as_ref()?;
        let contact = |race: Race| self.contact_of(&switch.raceways[race], race, conditions, None);
        Some((PerRace::new(contact), switch.residual))
    }
}
