//! Folders of the building machine in a library: messages of panics name the files of all crates with them.

use std::collections::BTreeSet;

use memchr::memmem;

/// Folders before the files of a crate, and how many folders follow them that are of the machine, too.
const BEFORE_CRATES: [(&str, usize); 3] =
    [("/registry/src/", 1), ("/git/checkouts/", 2), ("/rustlib/src/rust/library/", 0)];
/// Folders that the makers of Rust have put in place of theirs.
const OF_RUST: [&str; 2] = ["/rustc/", "/rust/deps/"];
/// Rust ends names of files by a zero, for C.
const END: &[u8] = b".rs\0";
/// Text in place of a folder; the rest of its length is filled with separators.
const CRATES: &[u8] = b"crates";

/// Overwrites the folders of source files by `crates////`, in place: nothing moves, and a name stays a name of the same file.
/// `/home/me/.cargo/registry/src/index-1949/nalgebra-0.35.0/src/base/matrix.rs` keeps what is behind the index, and so do sources of
/// a version control and of Rust's library; of other absolute names the file alone is kept.
pub fn hide(library: &mut [u8]) {
    let names = names(library);
    let mut folders = BTreeSet::new();
    for name in &names {
        let text = &library[name.clone()];
        if let Some(length) = folder(text) {
            folders.insert(text[..length].to_vec());
            overwrite(&mut library[name.start..name.start + length]);
        }
    }
    // Other text may stand before a name without a zero between, and names without a zero behind them may be anywhere.
    let separators = |folder: &[u8]| folder.iter().filter(|byte| b"/\\".contains(byte)).count();
    for folder in folders.iter().filter(|folder| separators(folder) > 2) {
        let places: Vec<usize> = memmem::find_iter(library, folder).collect();
        for place in places {
            overwrite(&mut library[place..place + folder.len()]);
        }
    }
}

/// Texts between zeros that end as names of source files.
fn names(library: &[u8]) -> Vec<std::ops::Range<usize>> {
    let range = |end: usize| {
        let end = end + END.len() - 1;
        let start = memchr::memrchr(0, &library[..end]).map_or(0, |zero| zero + 1);
        start..end
    };
    memmem::find_iter(library, END).map(range).collect()
}

/// Length of the folder of an absolute name that is of the machine.
fn folder(name: &[u8]) -> Option<usize> {
    let name = String::from_utf8(name.to_vec()).ok()?.replace('\\', "/");
    let drive = name.strip_prefix(|letter: char| letter.is_ascii_alphabetic());
    let absolute = name.starts_with('/') || drive.is_some_and(|rest| rest.starts_with(":/"));
    if !absolute || OF_RUST.iter().any(|folder| name.starts_with(folder)) {
        return None;
    }
    let crate_of = |&(before, folders): &(&str, usize)| {
        let start = name.find(before)? + before.len();
        let separators = name[start..].match_indices('/').map(|(at, _)| start + at + 1);
        [start].into_iter().chain(separators).nth(folders)
    };
    BEFORE_CRATES.iter().find_map(crate_of).or_else(|| Some(name.rfind('/')? + 1))
}

/// Writes as much of `crates////` over a folder as it is long; it ends with its own separator.
fn overwrite(folder: &mut [u8]) {
    let Some((&mut separator, rest)) = folder.split_last_mut() else { return };
    rest.fill(separator);
    if rest.len() >= CRATES.len() {
        rest[..CRATES.len()].copy_from_slice(CRATES);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A library with these texts, after its folders are hidden.
    fn hidden(text: &str) -> String {
        let mut library = text.as_bytes().to_vec();
        hide(&mut library);
        assert_eq!(library.len(), text.len(), "nothing moves");
        String::from_utf8(library).unwrap_or_default()
    }

    #[test]
    fn folders_are_overwritten_up_to_the_crate() {
        for (folder, kept) in [
            ("/home/me/.cargo/registry/src/index-1949cf8c/", "nalgebra-0.35.0/src/base/matrix.rs"),
            ("/home/me/.cargo/git/checkouts/nalgebra-1f2e/0a1b2c/", "src/base/matrix.rs"),
            ("/home/me/.rustup/toolchains/1.95/lib/rustlib/src/rust/library/", "core/src/slice/mod.rs"),
            // Nothing is known of these folders but that the file is in them.
            ("/home/me/src/bearing/vendor/nalgebra/src/base/", "matrix.rs"),
            ("/srv/target/release/build/serde-1f2e/out/", "private.rs"),
            ("C:\\Users\\me\\.cargo\\registry\\src\\index-1949cf8c\\", "toml-1.0.0\\src\\lib.rs"),
            ("D:\\a\\b\\", "lib.rs"),
            ("/a/", "lib.rs"),
        ] {
            let text = hidden(&format!("text\0{folder}{kept}\0text"));
            let separator = &folder[folder.len() - 1..];
            let crates = if folder.len() > CRATES.len() { "crates" } else { "" };
            let filled = format!("{crates}{}", separator.repeat(folder.len() - crates.len()));
            assert_eq!(text, format!("text\0{filled}{kept}\0text"));
        }
    }

    #[test]
    fn names_that_are_of_no_machine_stay() {
        for name in [
            "src/numerics/newton.rs",
            "/rustc/59807616e1fa2540724bfbac14d7976d7e4a3860/library/core/src/fmt/mod.rs",
            "/rust/deps/gimli-0.32.3/src/read/abbrev.rs",
            "crates////nalgebra-0.35.0/src/base/matrix.rs",
        ] {
            let text = format!("text\0{name}\0text");
            assert_eq!(hidden(&text), text);
        }
    }

    #[test]
    fn a_folder_that_is_known_is_overwritten_anywhere() {
        let folder = "/home/me/.cargo/registry/src/index-1949cf8c/";
        let text =
            hidden(&format!("\0{folder}a-1/src/a.rs\0a message{folder}b-2/src/b.rs\0{folder}c-3/c.css"));
        assert!(!text.contains("home") && text.contains("a message"), "{text}");
        assert_eq!(text.matches("crates///").count(), 3, "{text}");
    }
}
