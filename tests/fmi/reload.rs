//! An importer that unloads the library between two instances, as Ecos does: the first one lives on.
#![cfg(target_os = "linux")]

use std::ffi::{CStr, CString, c_char, c_int, c_void};

use roulement::fmi::v2::{CallbackFunctions, Status};
use roulement::fmi::v3;

use crate::fmi2_abi::{Component, Package, scene_text};

unsafe extern "C" {
    fn dlopen(file: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    fn dlclose(library: *mut c_void) -> c_int;
}

type Instantiate = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const CallbackFunctions,
    c_int,
    c_int,
) -> Component;
type Setup = unsafe extern "C" fn(Component, c_int, f64, f64, c_int, f64) -> Status;
type Simple = unsafe extern "C" fn(Component) -> Status;
type DoStep = unsafe extern "C" fn(Component, f64, f64, c_int) -> Status;
type GetReal = unsafe extern "C" fn(Component, *const u32, usize, *mut f64) -> Status;

/// The library as importers load it.
struct Library(*mut c_void);

impl Library {
    fn load() -> Self {
        const NOW: c_int = 2;
        let beside = std::env::current_exe().unwrap().with_file_name("libroulement.so");
        let file = CString::new(beside.to_str().unwrap()).unwrap();
        let library = unsafe { dlopen(file.as_ptr(), NOW) };
        assert!(!library.is_null(), "{} cannot be loaded", beside.display());
        Self(library)
    }

    fn function<F: Copy>(&self, name: &CStr) -> F {
        let address = unsafe { dlsym(self.0, name.as_ptr()) };
        assert!(!address.is_null(), "{name:?}");
        unsafe { std::mem::transmute_copy(&address) }
    }

    fn start(&self, package: &Package) -> Component {
        let (guid, location) = (package.guid.as_ptr(), package.location.as_ptr());
        unsafe {
            let instantiate = self.function::<Instantiate>(c"fmi2Instantiate");
            let c = instantiate(c"bearing".as_ptr(), 1, guid, location, &package.callbacks, 0, 0);
            assert!(!c.is_null());
            assert_eq!(self.function::<Setup>(c"fmi2SetupExperiment")(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
            assert_eq!(self.function::<Simple>(c"fmi2EnterInitializationMode")(c), Status::Ok);
            assert_eq!(self.function::<Simple>(c"fmi2ExitInitializationMode")(c), Status::Ok);
            c
        }
    }

    /// Force after ten steps.
    fn run(&self, c: Component, reference: u32) -> f64 {
        let mut force = f64::NAN;
        unsafe {
            for k in 0..10 {
                let status = self.function::<DoStep>(c"fmi2DoStep")(c, f64::from(k) * 1e-4, 1e-4, 0);
                assert_eq!(status, Status::Ok);
            }
            assert_eq!(self.function::<GetReal>(c"fmi2GetReal")(c, &reference, 1, &mut force), Status::Ok);
        }
        force
    }

    fn unload(self) {
        assert_eq!(unsafe { dlclose(self.0) }, 0);
    }
}

#[test]
fn regression_an_instance_outlives_the_unloading_of_its_library() {
    let package = Package::new("reload", &scene_text("wrench"));
    let force = package.reference("inner.force.x");
    let library = Library::load();
    let first = library.start(&package);
    library.unload();
    let library = Library::load();
    let second = library.start(&package);
    let forces = [first, second].map(|c| library.run(c, force));
    assert!(forces[0] < -500.0 && forces[0] == forces[1], "{forces:?}");
    library.unload();
}

#[test]
fn regression_an_instance_of_version_3_outlives_the_unloading_of_its_library() {
    type Instantiate3 = unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        *const c_char,
        bool,
        bool,
        bool,
        bool,
        *const u32,
        usize,
        Component,
        *const c_void,
        *const c_void,
    ) -> Component;
    type Enter3 = unsafe extern "C" fn(Component, bool, f64, f64, bool, f64) -> v3::Status;
    type Exit3 = unsafe extern "C" fn(Component) -> v3::Status;
    type Flag = *mut bool;
    type DoStep3 = unsafe extern "C" fn(Component, f64, f64, bool, Flag, Flag, Flag, *mut f64) -> v3::Status;
    type GetFloat64 = unsafe extern "C" fn(Component, *const u32, usize, *mut f64, usize) -> v3::Status;
    let package = Package::new("reload3", &scene_text("wrench"));
    let (force, resources) = (package.reference("inner.force.x"), package.resources());
    let start = |library: &Library| unsafe {
        let instantiate = library.function::<Instantiate3>(c"fmi3InstantiateCoSimulation");
        let (name, token, none) = (c"bearing".as_ptr(), package.guid.as_ptr(), std::ptr::null());
        let nothing = std::ptr::null_mut();
        let c = instantiate(
            name,
            token,
            resources.as_ptr(),
            false,
            false,
            false,
            false,
            std::ptr::null(),
            0,
            nothing,
            none,
            none,
        );
        assert!(!c.is_null());
        let enter = library.function::<Enter3>(c"fmi3EnterInitializationMode");
        assert_eq!(enter(c, false, 0.0, 0.0, false, 0.0), v3::Status::Ok);
        assert_eq!(library.function::<Exit3>(c"fmi3ExitInitializationMode")(c), v3::Status::Ok);
        c
    };
    let run = |library: &Library, c: Component| unsafe {
        let (mut flags, mut value) = ([false; 3], f64::NAN);
        let [event, end, early] = &mut flags;
        for k in 0..10 {
            let step = library.function::<DoStep3>(c"fmi3DoStep");
            let time = f64::from(k) * 1e-4;
            assert_eq!(step(c, time, 1e-4, false, event, end, early, &mut value), v3::Status::Ok);
        }
        let get = library.function::<GetFloat64>(c"fmi3GetFloat64");
        assert_eq!(get(c, &force, 1, &mut value, 1), v3::Status::Ok);
        value
    };
    let library = Library::load();
    let first = start(&library);
    library.unload();
    let library = Library::load();
    let second = start(&library);
    let forces = [first, second].map(|c| run(&library, c));
    assert!(forces[0] < -500.0 && forces[0] == forces[1], "{forces:?}");
    // The same bearing as through the other version.
    let third = library.start(&package);
    assert_eq!(library.run(third, force), forces[0]);
    library.unload();
}
