//! Link flags of the shared library, and the number of its build.

use std::env;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

/// What else a library depends on than its sources.
const SETTINGS: [&str; 6] =
    ["TARGET", "PROFILE", "OPT_LEVEL", "DEBUG", "CARGO_CFG_FEATURE", "CARGO_CFG_TARGET_FEATURE"];

/// Names and bytes of all files in a folder, or of one file.
fn hash(path: &Path, hasher: &mut DefaultHasher) -> io::Result<()> {
    if path.is_dir() {
        let mut entries: Vec<_> = fs::read_dir(path)?.collect::<Result<_, _>>()?;
        entries.sort_by_key(fs::DirEntry::file_name);
        return entries.iter().try_for_each(|entry| hash(&entry.path(), hasher));
    }
    path.file_name().hash(hasher);
    fs::read(path)?.hash(hasher);
    Ok(())
}

/// Makes one of functions that are the same: 40 kB of the library. LLD and mold know it, which Rust and many systems link with.
const FOLD: &str = "-Wl,--icf=all";

/// Does the linker of this build know [`FOLD`]? GNU's, for one, ends with an error: an empty library is linked to find out, and what is said of it stays
/// beside it.
fn linker_folds() -> Option<bool> {
    let folder = env::var_os("OUT_DIR")?;
    let [source, probe, said] =
        ["probe.rs", "probe.so", "probe.txt"].map(|name| Path::new(&folder).join(name));
    fs::write(&source, "").ok()?;
    let linker = env::var("RUSTC_LINKER").map(|linker| format!("-Clinker={linker}"));
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    let mut command = Command::new(env::var_os("RUSTC")?);
    command.args(["--crate-name", "probe", "--crate-type", "cdylib", "--target", &env::var("TARGET").ok()?]);
    command.args(linker.iter()).args(flags.split('\x1f').filter(|flag| !flag.is_empty()));
    command.arg(format!("-Clink-arg={FOLD}")).arg("-o").arg(probe).arg(source);
    let output =
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(fs::File::create(said).ok()?).status();
    Some(output.ok()?.success())
}

fn main() -> io::Result<()> {
    let mut hasher = DefaultHasher::new();
    // A crate alone has no lock file.
    for source in ["build.rs", "Cargo.toml", "Cargo.lock", "src"]
        .map(Path::new)
        .into_iter()
        .filter(|path| path.exists())
    {
        println!("cargo::rerun-if-changed={}", source.display());
        hash(source, &mut hasher)?;
    }
    SETTINGS.map(|name| env::var(name).ok()).hash(&mut hasher);
    // Programs find the library that was built together with them by it (src/fmi/build.rs).
    println!("cargo::rustc-env=ROULEMENT_BUILD={:016x}", hasher.finish());

    // Importers may unload the library between two instances, and the first with it (Ecos does). It stays loaded; on
    // Windows it sees to that itself (src/fmi/stay.rs).
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        println!("cargo::rustc-link-arg-cdylib=-Wl,-z,nodelete");
        if linker_folds() == Some(true) {
            println!("cargo::rustc-link-arg-cdylib={FOLD}");
        }
    }
    Ok(())
}
