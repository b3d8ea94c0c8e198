//! The library's C interface as an importer sees it, and packages unpacked to folders.
#![allow(dead_code, non_snake_case, unsafe_code, missing_docs)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;
use std::ptr;
use std::sync::atomic::{AtomicU32, Ordering};

use roulement::fmi::v2::{CallbackFunctions, Status};
use roulement::interface::model_description::{all, render};
use roulement::interface::variables::{Causality, MachineVariables, Variable, Variables};
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::system::System;

pub type Component = *mut c_void;
pub type State = *mut c_void;
type Reals = *mut f64;
type References = *const u32;

unsafe extern "C" {
    pub fn fmi2GetTypesPlatform() -> *const c_char;
    pub fn fmi2GetVersion() -> *const c_char;
    pub fn fmi2Instantiate(
        name: *const c_char,
        kind: c_int,
        guid: *const c_char,
        resources: *const c_char,
        functions: *const CallbackFunctions,
        visible: c_int,
        logging: c_int,
    ) -> Component;
    pub fn fmi2FreeInstance(c: Component);
    pub fn fmi2SetDebugLogging(c: Component, on: c_int, n: usize, categories: *const *const c_char)
    -> Status;
    pub fn fmi2SetupExperiment(c: Component, d: c_int, t: f64, start: f64, s: c_int, stop: f64) -> Status;
    pub fn fmi2EnterInitializationMode(c: Component) -> Status;
    pub fn fmi2ExitInitializationMode(c: Component) -> Status;
    pub fn fmi2Terminate(c: Component) -> Status;
    pub fn fmi2Reset(c: Component) -> Status;
    pub fn fmi2GetReal(c: Component, r: References, n: usize, values: Reals) -> Status;
    pub fn fmi2GetInteger(c: Component, r: References, n: usize, values: *mut c_int) -> Status;
    pub fn fmi2GetBoolean(c: Component, r: References, n: usize, values: *mut c_int) -> Status;
    pub fn fmi2GetString(c: Component, r: References, n: usize, values: *mut *const c_char) -> Status;
    pub fn fmi2SetReal(c: Component, r: References, n: usize, values: *const f64) -> Status;
    pub fn fmi2SetInteger(c: Component, r: References, n: usize, values: *const c_int) -> Status;
    pub fn fmi2SetBoolean(c: Component, r: References, n: usize, values: *const c_int) -> Status;
    pub fn fmi2SetString(c: Component, r: References, n: usize, values: *const *const c_char) -> Status;
    pub fn fmi2GetFMUstate(c: Component, state: *mut State) -> Status;
    pub fn fmi2SetFMUstate(c: Component, state: State) -> Status;
    pub fn fmi2FreeFMUstate(c: Component, state: *mut State) -> Status;
    pub fn fmi2SerializedFMUstateSize(c: Component, state: State, size: *mut usize) -> Status;
    pub fn fmi2SerializeFMUstate(c: Component, state: State, bytes: *mut u8, size: usize) -> Status;
    pub fn fmi2DeSerializeFMUstate(c: Component, bytes: *const u8, size: usize, state: *mut State) -> Status;
    pub fn fmi2GetDirectionalDerivative(
        c: Component,
        unknowns: References,
        n_unknowns: usize,
        knowns: References,
        n_knowns: usize,
        changes: *const f64,
        results: Reals,
    ) -> Status;
    pub fn fmi2SetRealInputDerivatives(
        c: Component,
        r: References,
        n: usize,
        orders: *const c_int,
        values: *const f64,
    ) -> Status;
    pub fn fmi2GetRealOutputDerivatives(
        c: Component,
        r: References,
        n: usize,
        orders: *const c_int,
        values: Reals,
    ) -> Status;
    pub fn fmi2DoStep(c: Component, time: f64, step: f64, no_set_prior: c_int) -> Status;
    pub fn fmi2CancelStep(c: Component) -> Status;
    pub fn fmi2GetStatus(c: Component, kind: c_int, value: *mut Status) -> Status;
    pub fn fmi2GetRealStatus(c: Component, kind: c_int, value: *mut f64) -> Status;
    pub fn fmi2GetIntegerStatus(c: Component, kind: c_int, value: *mut c_int) -> Status;
    pub fn fmi2GetBooleanStatus(c: Component, kind: c_int, value: *mut c_int) -> Status;
    pub fn fmi2GetStringStatus(c: Component, kind: c_int, value: *mut *const c_char) -> Status;
}

pub const LAST_SUCCESSFUL_TIME: c_int = 2;

/// A small bearing, quick to start and to step; `drive` is pose or wrench.
pub fn scene_text(drive: &str) -> String {
    format!(
        r#"
        [bearing]
        balls = 4
        ball_diameter = "9.525 mm"
        pitch_diameter = "46 mm"
        contact_angle = "25 deg"
        inner_conformity = 0.52
        outer_conformity = 0.52
        [effects]
        damping = "0.02 s/m"
        [inner]
        drive = "{drive}"
        mass = "0.2 kg"
        inertia = ["6e-5 kg m^2", "4e-5 kg m^2", "4e-5 kg m^2"]
        [load]
        inner_speed = "6000 rpm"
        x = {{ force = "600 N" }}
        "#
    )
}

/// The scene with the pose of the inner race as an input, its orientation written in one of the forms.
pub fn pose_text(orientation: &str) -> String {
    format!("{}\n[interface]\norientation = \"{orientation}\"\n", scene_text("pose"))
}

/// The unpacked package of a scene.
pub struct Package {
    folder: PathBuf,
    pub guid: CString,
    pub location: CString,
    pub rows: Vec<Variable>,
    pub callbacks: CallbackFunctions,
}

// SAFETY: the only pointer in it is null.
unsafe impl Sync for Package {}

impl Package {
    /// `name` tells the folders of tests that run at the same time apart.
    pub fn new(name: &str, text: &str) -> Self {
        let scene = Scene::parse(text).unwrap();
        let guid = render(&Simulation::new(&scene).unwrap(), "bearing", &all).unwrap().guid;
        Self::of(name, text, guid, Variables::new(&scene).rows().to_vec())
    }

    /// That of a shaft with its bearings.
    pub fn of_system(name: &str, text: &str) -> Self {
        let scene = SystemScene::parse(text, None, "".as_ref()).unwrap();
        let system = System::new(&scene).unwrap();
        let guid = render(&system, "bearing", &all).unwrap().guid;
        Self::of(name, &scene.source, guid, MachineVariables::new(&system).rows().to_vec())
    }

    fn of(name: &str, source: &str, guid: String, rows: Vec<Variable>) -> Self {
        // A folder of its own, whatever other threads of this process do.
        static PACKAGES: AtomicU32 = AtomicU32::new(0);
        let number = PACKAGES.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir().join(format!("roulement-{name}-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("scene.toml"), source).unwrap();
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::null_mut(),
        };
        Self {
            guid: CString::new(guid).unwrap(),
            location: CString::new(format!("file://{}", folder.display())).unwrap(),
            rows,
            folder,
            callbacks,
        }
    }

    pub fn instantiate(&self) -> Component {
        let (guid, location) = (self.guid.as_ptr(), self.location.as_ptr());
        // SAFETY: all pointers live through the call.
        let c = unsafe { fmi2Instantiate(c"bearing".as_ptr(), 1, guid, location, &self.callbacks, 0, 0) };
        assert!(!c.is_null());
        c
    }

    /// An instance whose messages, with their categories, go to `messages`.
    pub fn instantiate_logging(&self, messages: &Messages) -> Component {
        type Fixed = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char);
        type Variadic =
            unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);
        let callbacks = CallbackFunctions {
            // SAFETY: what is variadic is not read: the same call on the platforms of packages (FMPy does it, too).
            logger: Some(unsafe { std::mem::transmute::<Fixed, Variadic>(keep) }),
            component_environment: ptr::from_ref(messages).cast_mut().cast(),
            ..self.callbacks
        };
        let (guid, location) = (self.guid.as_ptr(), self.location.as_ptr());
        // SAFETY: all pointers live through the call, the messages as long as the instance.
        let c = unsafe { fmi2Instantiate(c"bearing".as_ptr(), 1, guid, location, &callbacks, 0, 0) };
        assert!(!c.is_null());
        c
    }

    /// Instantiated and initialised, at time 0.
    pub fn start(&self) -> Component {
        let c = self.instantiate();
        initialise(c);
        c
    }

    /// Folder of the resources, as FMI 3.0 has it.
    pub fn resources(&self) -> CString {
        CString::new(self.folder.to_str().unwrap()).unwrap()
    }

    pub fn reference(&self, name: &str) -> u32 {
        self.rows.iter().position(|row| row.name == name).unwrap() as u32
    }

    pub fn references(&self, causality: Causality) -> Vec<u32> {
        (0..self.rows.len() as u32).filter(|&r| self.rows[r as usize].causality == causality).collect()
    }
}

/// Messages of an instance: status, category, text.
pub type Messages = std::sync::Mutex<Vec<(Status, String, String)>>;

unsafe extern "C" fn keep(
    messages: *mut c_void,
    _: *const c_char,
    status: Status,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: as instantiated: the messages live, the texts are C strings.
    unsafe {
        let [category, text] =
            [category, text].map(|text| CStr::from_ptr(text).to_string_lossy().into_owned());
        (*messages.cast::<Messages>()).lock().unwrap().push((status, category, text));
    }
}

impl Drop for Package {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

pub fn initialise(c: Component) {
    // SAFETY: a live instance.
    unsafe {
        assert_eq!(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
        assert_eq!(fmi2EnterInitializationMode(c), Status::Ok);
        assert_eq!(fmi2ExitInitializationMode(c), Status::Ok);
    }
}

/// The whole state as bytes.
pub fn state_bytes(c: Component) -> Vec<u8> {
    let (mut state, mut size) = (ptr::null_mut(), 0);
    // SAFETY: a live instance; all pointers live through the calls.
    unsafe {
        assert_eq!(fmi2GetFMUstate(c, &mut state), Status::Ok);
        assert_eq!(fmi2SerializedFMUstateSize(c, state, &mut size), Status::Ok);
        let mut bytes = vec![0; size];
        assert_eq!(fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size), Status::Ok);
        assert_eq!(fmi2FreeFMUstate(c, &mut state), Status::Ok);
        bytes
    }
}

pub fn real(c: Component, reference: u32) -> f64 {
    let mut value = f64::NAN;
    // SAFETY: a live instance; all pointers live through the call.
    assert_eq!(unsafe { fmi2GetReal(c, &reference, 1, &mut value) }, Status::Ok);
    value
}
