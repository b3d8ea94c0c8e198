//! Twins of a scene: the same with an effect taken in or out. What an effect changes is the difference of both.

use crate::effects::Effects;

/// Switch that takes an effect in or out.
pub type Switch = Box<dyn Fn(&mut Effects)>;

/// A scene without an effect and the same with it: one of them is the scene itself.
pub struct Twin {
    /// Key of the effect.
    pub key: &'static str,
    /// Subject in a few words.
    pub subject: &'static str,
    /// Is it in the scene?
    pub on: bool,
    /// As what it is taken in, with units; empty where it is simply on.
    pub setting: String,
    /// Takes out what is in the scene or takes in what is not. There are several where data are not known: the largest change counts.
    pub switches: Vec<Switch>,
    /// Which of several each of these is, in a few words; none of a single one.
    pub ways: &'static [&'static str],
    /// Change that both twins have in common and the scene does not have.
    pub common: Option<Switch>,
    /// Are changes those of an instant alone, which a turn takes away from means: from torque and life?
    pub passing: bool,
    /// Text to write in the scene to switch it on, or what that needs.
    pub write: &'static str,
    /// Key that switches it on, where the scene has all it needs: what `effects = "auto"` sets.
    pub auto: Option<&'static str>,
    /// More to be said of it.
    pub remark: String,
    /// Does it matter whatever it changes at a settled state?
    pub always_matters: bool,
    /// What it changes of motions that a settled state does not have, vibration or how balls come to turn, in words. Less of a settled change
    /// matters then.
    pub unsettled: Option<&'static str>,
}

impl Twin {
    /// Twin of an effect that a function switches.
    pub fn new(
        key: &'static str,
        subject: &'static str,
        on: bool,
        switch: impl Fn(&mut Effects) + 'static,
    ) -> Self {
        Self {
            key,
            subject,
            on,
            setting: String::new(),
            switches: vec![Box::new(switch)],
            ways: &[],
            common: None,
            passing: false,
            write: "",
            auto: None,
            remark: String::new(),
            always_matters: false,
            unsettled: None,
        }
    }

    /// With what it is taken in as.
    #[must_use]
    pub fn taken_as(self, setting: impl Into<String>) -> Self {
        Self { setting: setting.into(), ..self }
    }

    /// With one more way to take it in.
    #[must_use]
    pub fn or(mut self, switch: impl Fn(&mut Effects) + 'static) -> Self {
        self.switches.push(Box::new(switch));
        self
    }

    /// With words for each of its switches.
    #[must_use]
    pub fn named(self, ways: &'static [&'static str]) -> Self {
        Self { ways, ..self }
    }

    /// With what to write in the scene.
    #[must_use]
    pub fn written(self, write: &'static str) -> Self {
        Self { write, ..self }
    }

    /// With the key that switches it on, if that is all it needs.
    #[must_use]
    pub fn automatic(self, auto: Option<&'static str>) -> Self {
        Self { auto, ..self }
    }

    /// With more to be said.
    #[must_use]
    pub fn remarked(self, remark: impl Into<String>) -> Self {
        Self { remark: remark.into(), ..self }
    }
}
