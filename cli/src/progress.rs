//! How far something has come, on stderr, and what is left; in a browser, where nobody sees stderr, nothing.

#[cfg(not(target_family = "wasm"))]
pub use indicatif::ProgressBar;
#[cfg(target_family = "wasm")]
pub use none::ProgressBar;

/// A bar of a length, which may be told later, by a template of indicatif.
#[cfg(not(target_family = "wasm"))]
pub fn bar(length: Option<u64>, template: &str) -> ProgressBar {
    let bar = length.map_or_else(ProgressBar::no_length, ProgressBar::new);
    if let Ok(style) = indicatif::ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

/// No bar.
#[cfg(target_family = "wasm")]
pub fn bar(_: Option<u64>, _: &str) -> ProgressBar {
    ProgressBar
}

#[cfg(target_family = "wasm")]
mod none {
    /// No bar: what commands say to one.
    pub struct ProgressBar;

    #[expect(missing_docs, reason = "as of indicatif")]
    impl ProgressBar {
        pub fn inc(&self, _: u64) {}
        pub fn reset(&self) {}
        pub fn set_length(&self, _: u64) {}
        pub fn set_message(&self, _: impl Into<std::borrow::Cow<'static, str>>) {}
        pub fn set_position(&self, _: u64) {}
        pub fn finish_and_clear(&self) {}
        pub fn suspend<T>(&self, work: impl FnOnce() -> T) -> T {
            work()
        }
    }
}
