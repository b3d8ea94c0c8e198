//! Link flags of the shared library.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Importers may unload the library between two instances, and the first with it (Ecos does). It stays loaded; on
    // Windows it sees to that itself (src/fmi/v2/stay.rs).
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "linux") {
        println!("cargo::rustc-link-arg-cdylib=-Wl,-z,nodelete");
    }
}
