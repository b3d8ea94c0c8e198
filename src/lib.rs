//! A ball bearing in three dimensions for gearbox simulation: the dynamic model of Bovet, Linares, Zamponi and Mermoz
//! (Mechanics & Industry 14, 2013; "the paper") as a library and as an FMI 2.0 co-simulation unit.
//!
//! Balls, a race that forces move, and the cage are rigid bodies. They touch in exact torus geometry with Hertz's load and
//! Kalker's creep forces; implicit HHT steps with exact derivatives integrate their equations. The equations are in
//! `docs/model.md`, decisions and what they were measured with in `docs/decisions/`.
//!
//! # A run
//!
//! A [`Scene`] describes a bearing, its load and the effects to be simulated. A [`Simulation`] starts from the quasi-static
//! equilibrium; [`Simulation::advance`] takes as many of its own steps as accuracy asks for and ends exactly at the time
//! wanted.
//!
//! ```
//! use roulement::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::parse(
//!     r#"
//!     [bearing]
//!     balls = 10
//!     ball_diameter = "9.525 mm"
//!     pitch_diameter = "46 mm"
//!     contact_angle = "25 deg"
//!     inner_conformity = 0.52
//!     outer_conformity = 0.52
//!
//!     [inner]
//!     drive = "wrench"
//!     mass = "0.2 kg"
//!     inertia = ["6e-5 kg m^2", "4e-5 kg m^2", "4e-5 kg m^2"]
//!
//!     [load]
//!     duration = "50 ms"
//!     output_interval = "100 us"
//!     inner_speed = "6000 rpm"
//!     x = { force = "1500 N" }
//!     "#,
//! )?;
//! let mut simulation = Simulation::new(&scene)?;
//! simulation.advance(1e-3)?;
//!
//! let outputs = simulation.outputs();
//! for ball in &outputs.balls {
//!     println!("{:.1} N inside, {:.1} N outside", ball.inner.load, ball.outer.load);
//! }
//! // The bearing pushes the race back with the load, but for what accelerates the race.
//! assert!((outputs.inner.wrench.force.x / -1500.0 - 1.0).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! # Step by step
//!
//! A master that moves the race gives its pose and reads the wrench: [`Inputs`] are those at the start of a step. A [`snapshot`]
//! brings a simulation back, to the same bits.
//!
//! [`snapshot`]: Simulation::snapshot
//!
//! ```
//! use roulement::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::load("scenes/misalignment.toml".as_ref())?;
//! let mut simulation = Simulation::new(&scene)?;
//! let before = simulation.snapshot();
//!
//! let mut inputs = *simulation.inputs();
//! let speed = 6000.0 * std::f64::consts::PI / 30.0;
//! inputs.inner.axis = Some(AxisInput {
//!     rate: [speed, 0.0, 1.0].into(), // [rad/s] it spins, and its axis tilts about z
//!     ..AxisInput::default()
//! });
//! simulation.set_inputs(inputs);
//! simulation.advance(1e-4)?;
//! let moment = simulation.outputs().inner.wrench.moment.z;
//! assert!(moment < 0.0); // the bearing pushes back
//!
//! assert!(simulation.restore(&before));
//! simulation.set_inputs(inputs);
//! simulation.advance(1e-4)?;
//! assert_eq!(simulation.outputs().inner.wrench.moment.z.to_bits(), moment.to_bits());
//! # Ok(())
//! # }
//! ```
//!
//! # From a catalogue, and what matters
//!
//! [`catalogue`] estimates what is inside a bearing of a name. [`analysis::estimate`] says which effects would matter to it, and by how
//! much.
//!
//! ```
//! use roulement::analysis::estimate;
//! use roulement::catalogue::Request;
//! use roulement::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let request = Request { designation: Some("7206 B".to_string()), ..Request::default() };
//! let scene = Scene::parse(&request.bearing()?.scene(1)?)?;
//! let verdicts = estimate::verdicts(&scene, &Model::new(&scene)?)?;
//! for verdict in verdicts.iter().filter(|verdict| verdict.matters) {
//!     println!("{}: {}", verdict.subject, verdict.sentence);
//! }
//! assert!(verdicts.iter().any(|verdict| verdict.subject == "film" && verdict.matters));
//! # Ok(())
//! # }
//! ```
//!
//! # A single contact
//!
//! [`analysis::single_contact`] has every creep law on one rolling contact, the half-space reference among them.
//!
//! ```
//! use roulement::analysis::single_contact::{Law, RollingContact};
//! use roulement::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let contact = RollingContact {
//!     id: "long ellipse, spin".to_string(),
//!     poisson_ratio: 0.3,
//!     shear_modulus: 80.8e9,
//!     friction: 0.08,
//!     peak_pressure: 1.5e9,
//!     semi_axis_x: 0.1e-3,
//!     semi_axis_y: 0.8e-3,
//!     rolling_angle: 0.0,
//!     creep_x: 0.5e-3,
//!     creep_y: 0.0,
//!     spin: 3.0,
//!     curvature: 0.0,
//! };
//! let fast = contact.evaluate(Law::Simulated(CreepLaw::KalkerTable))?;
//! let exact = contact.evaluate(Law::Reference(24))?;
//! println!("{:.3} and {:.3} of mu N", fast.fx, exact.fx);
//! assert!((fast.fx - exact.fx).abs() < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! # An equilibrium
//!
//! [`equilibrium::solve`] finds displacements, ball loads and stiffness without integration in time.
//!
//! ```
//! use roulement::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::load("scenes/radial.toml".as_ref())?;
//! let input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
//! let solution = equilibrium::solve(&Model::new(&scene)?, &input)?;
//!
//! println!("{:.1} um, {:.0} N/um", solution.displacement[1] * 1e6, solution.stiffness[(1, 1)] * 1e-6);
//! assert!((solution.load[1] - 1500.0).abs() < 1e-6);
//! # Ok(())
//! # }
//! ```
//!
//! # Rooms
//!
//! In the order in which data pass through them:
//!
//! | room | contents |
//! |---|---|
//! | [`numerics`] | methods that know nothing of bearings: numbers with derivatives, rotations, Newton's method, HHT steps |
//! | [`kalker`] | rolling contact theories of one scaled patch: linear, polynomials, table, half-space reference |
//! | [`loads`] | unbalance and gears: what parts of a machine do to their shaft |
//! | [`contact`] | one contact of a ball with a race, its pocket or another ball, or of the cage with a land: from motion to forces |
//! | [`schema`] | the parts of a scene: sections, units, schedules, ranges, errors |
//! | [`effects`] | effects that a scene can switch on, a file each |
//! | [`scene`] | the whole scene file: what its parts have to agree on |
//! | [`model`] | the constants of a run, built from the scene, and the plain data of its state |
//! | [`forces`] | all pairs of bodies that touch, and the sums of their forces |
//! | [`equilibrium`] | quasi-static solution, where every simulation starts |
//! | [`dynamics`] | one implicit step of all bodies: residual, Newton matrix, local error |
//! | [`analysis`] | stiffness and damping of a running bearing; single rolling contacts |
//! | [`catalogue`] | catalogue bearings, by name or by their numbers, as texts of scenes |
//! | [`simulation`] | the running bearing: inputs, start, steps between communication points, outputs |
//! | [`interface`] | the table of variables, and the model description and documentation made from it |
//! | [`fmi`] | the C functions of FMI 2.0 |
//!
//! [`prelude`] names what most programs need. The command line is a crate of its own, in `cli/`.
//!
//! # Frames and symbols
//!
//! | frame | axes and origin |
//! |---|---|
//! | W, world | right-handed; x is the bearing axis, origin at the centre of the unloaded bearing; azimuths count from +y towards +z |
//! | R, race | fixed in a race; x is its own axis, origin at the bearing centre of the unloaded bearing |
//! | K, cage | fixed in the cage; x is its own axis, origin in the plane of the pockets |
//! | C, contact | x is the rolling direction, y transverse, z from the raceway into the ball; inside the kernel x is along the circumference, and `rolling_cosine` is that of the rolling direction |
//!
//! A wrench on a body is taken about its origin and given in W. Units are SI, angles in radians.
//!
//! | symbol | in code | meaning | unit | frame |
//! |---|---|---|---|---|
//! | psi | `azimuth` | azimuth of a ball about the outer race's axis | rad | W |
//! | alpha | `contact_angle` | contact angle, positive under thrust of the inner race along +x | rad | R |
//! | s | `distance` is its length | vector from groove centre to ball centre | m | W |
//! | n | `normal` | unit normal, out of the ball into the other body | - | W |
//! | delta | `approach` | approach of two bodies, positive in contact | m | |
//! | Q | `load` | normal load, `k delta^1.5 (1 + chi delta')` | N | C, z |
//! | k | `stiffness` | Hertz stiffness | N/m^1.5 | |
//! | chi | `damping` | Hunt-Crossley dissipation factor | s/m | |
//! | a, b | `semi_axis_rolling`, `semi_axis_transverse` | semi-axes of the contact ellipse | m | C, x and y |
//! | c | `mean_semi_axis` | `sqrt(a b)` | m | |
//! | p_0 | `peak_pressure` | peak of Hertz's pressure | Pa | |
//! | V | `rolling_speed` | speed of the contact point over the mean of both surfaces | m/s | C |
//! | c_x, c_y (Kalker: xi, eta) | `longitudinal`, `lateral` | creepages: slip of the ball over the other body, over V | - | C |
//! | phi | `spin` | spin creepage: relative angular velocity about the normal, over V | 1/m | C, z |
//! | kappa | `curvature` | slip `-kappa y^2` of a bent groove, over V (Heathcote) | 1/m^2 | C |
//! | F_x, F_y | `longitudinal`, `lateral` | creep forces of the ball on the other body | N | C |
//! | M_z | `spin_moment` | spin moment of the ball on the other body | N m | C, z |
//! | M_max | `moment_limit` | spin moment of complete sliding | N m | |
//! | mu | `friction` | friction coefficient | - | |
//! | G, nu | `shear_modulus`, `poisson_ratio` | combined elastic constants of the rolling contact | Pa, - | |
//! | C_ij | `c11`, `c22`, `c23`, `c33` | Kalker's creep coefficients: `F_x = G c^2 C11 c_x` and so on (eq. 14) | - | C |
//! | q | `q` | linear theory's forces over mu Q and M_max | - | C |
//! | M | `degree` | degree of Kalker's traction polynomials | - | |
//! | h | `h` | size of a step | s | |
//! | alpha_f | `alpha_f` | damping of the HHT scheme, in (0, 1/3] | - | |
//! | beta, gamma | `beta`, `gamma` | Newmark's parameters: `(1 + alpha_f)^2/4`, `1/2 + alpha_f` | - | |
//! | g | `total` | force or moment at one end of a step: `M a1 = (1 - alpha_f) g1 + alpha_f g0` | N, N m | W |
//! | K, C | `stiffness`, `damping` of [`analysis::condensed`] | derivatives of the load on the inner race by its displacement and velocity | N/m and so on | W |

pub mod analysis;
pub mod catalogue;
pub mod contact;
pub mod dynamics;
pub mod effects;
pub mod equilibrium;
// A browser loads no units.
#[cfg(not(target_family = "wasm"))]
pub mod fmi;
pub mod forces;
pub mod interface;
pub mod kalker;
pub mod loads;
pub mod model;
pub mod numerics;
pub mod prelude;
pub mod quasi_static;
pub mod scene;
pub mod schema;
pub mod simulation;

pub use model::Model;
pub use scene::{Scene, SceneError};
pub use simulation::inputs::Inputs;
pub use simulation::outputs::Outputs;
pub use simulation::{Simulation, SimulationError};
