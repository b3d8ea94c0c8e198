//! Meshes of a system as they are read, and the trains of shafts that meshes and couplings make.

use nalgebra::Vector3;

use super::SystemScene;
use super::ranges::POSITION;
use super::spring::SceneSpring;
use crate::model::link::gear_pair::{Gear, GearPair};
use crate::model::link::tooth_mesh::{ToothFriction, Varying};
use crate::model::link::variation::{Term, Variation};
use crate::numerics::periodic_spline::PeriodicSpline;
use crate::numerics::size::ascending;
use crate::schema::numbers::Range;
use crate::schema::units::{Quantity, Ratio};
use crate::schema::{MeshSection, Over, SceneError, ShaftSection, Varies};

const MODULE: Range = Range::closed(1e-5, 1.0, "m");
const PRESSURE_ANGLE: Range = Range::closed(0.1, 0.8, "rad");
const HELIX_ANGLE: Range = Range::closed(-1.2, 1.2, "rad");
const TEETH: Range = Range::closed(3.0, 1e4, "");
const WIDTH: Range = Range::closed(1e-5, 10.0, "m");
const SHIFT: Range = Range::closed(-3.0, 3.0, "");
const STIFFNESS: Range = Range::above(0.0, 1e15, "N/m");
const RATIO: Range = Range::closed(0.0, 10.0, "");
const PLAY: Range = Range::closed(0.0, 0.1, "m");
const FRICTION: Range = Range::closed(0.0, 1.0, "");
const ORDER: Range = Range::closed(1.0, 1000.0, "");
const PHASE: Range = Range::closed(-7.0, 7.0, "rad");
/// What is added to a stiffness of 1.
const OF_STIFFNESS: Range = Range::closed(-1.0, 10.0, "");
const ERROR: Range = Range::closed(-1e-2, 1e-2, "m");
/// Points of a curve.
const POINTS: Range = Range::closed(4.0, 100_000.0, "");
/// [m/s] pitch line velocity over which friction of teeth takes its sign: slow beside any gear that runs, and seen by steps.
const SLOW: f64 = 1e-3;
/// [-] of the module: how far a centre distance may be from that at which the teeth touch on both flanks.
const FITS: f64 = 0.5;

/// A mesh.
#[derive(Clone, Debug)]
pub struct SceneMesh {
    /// Its keys.
    pub section: MeshSection,
    /// The shafts of its gears, by their indices.
    pub shafts: [usize; 2],
    /// \[rad] how far the first gear is turned against the line of centres at the start: as a planet needs it that stands elsewhere than the first one.
    pub turned: f64,
}

impl SceneMesh {
    /// From the axis of the first gear towards the pitch point, a unit vector across x: towards the other axis, or away from that of a ring.
    pub fn towards(&self, scene: &SystemScene) -> Vector3<f64> {
        across(&scene.shafts, self.shafts).normalize() * self.pair(scene).centre_distance.signum()
    }

    /// \[m] the pitch point in the middle of the common face width, in the axes of all shafts.
    pub fn place(&self, scene: &SystemScene) -> Vector3<f64> {
        let [from, to] = common_face(&self.section, &scene.shafts, self.shafts);
        let axis = Vector3::from(scene.shafts[self.shafts[0]].place(0.0));
        let at = axis + self.towards(scene) * self.pair(scene).pitch_radii()[0];
        Vector3::new(0.5 * (from + to), at.y, at.z)
    }

    /// Its geometry.
    pub fn pair(&self, scene: &SystemScene) -> GearPair {
        pair(&self.section, &scene.shafts, self.shafts)
    }

    /// [-] turns of the second gear for one of the first.
    pub fn ratio(&self) -> f64 {
        let [one, other] = teeth(&self.section);
        -one / other
    }

    /// What varies as it turns; none where nothing does.
    pub fn varying(&self) -> Option<Varying> {
        let of = &self.section;
        let varies = !of.stiffness_variation.is_empty() || !of.transmission_error.is_empty();
        varies.then(|| Varying {
            turned: self.turned,
            stiffness: variation(&of.stiffness_variation, teeth(of)),
            error: variation(&of.transmission_error, teeth(of)),
        })
    }

    /// Friction of its teeth.
    pub fn friction(&self, scene: &SystemScene) -> Option<ToothFriction> {
        let coefficient = self.section.friction.filter(|coefficient| *coefficient > 0.0)?;
        let pair = self.pair(scene);
        let transverse = pair.base_radii()[0] * pair.base_helix_angle().cos();
        Some(ToothFriction {
            arm: coefficient * pair.loss_factor() * transverse * pair.turn(),
            slow: SLOW / (pair.pitch_radii()[0] * pair.turn()),
        })
    }
}

/// Numbers of teeth, negative where they are inside.
fn teeth(section: &MeshSection) -> [f64; 2] {
    section.gears.each_ref().map(|gear| f64::from(gear.teeth) * if gear.inside { -1.0 } else { 1.0 })
}

fn variation<Q: Quantity>(terms: &[Varies<Q>], [one, other]: [f64; 2]) -> Variation {
    let term = |of: &Varies<Q>| {
        let times = match of.over {
            Over::Tooth => one,
            Over::First => 1.0,
            Over::Second => -one / other,
        };
        match &of.values {
            Some(values) => {
                let points: Vec<[f64; 1]> = values.iter().map(|value| [value.si()]).collect();
                let curve = PeriodicSpline::through(&points)?;
                Some(Term::Table { times, curve, points: points.len() })
            }
            None => Some(Term::Wave {
                times: times * f64::from(of.order.unwrap_or(1)),
                amplitude: of.amplitude.map_or(0.0, Quantity::si),
                phase: of.phase.map_or(0.0, |phase| phase.0),
            }),
        }
    };
    Variation(terms.iter().filter_map(term).collect())
}

fn check_terms<Q: Quantity>(key: &str, terms: &[Varies<Q>], range: &Range) -> Result<(), SceneError> {
    for (index, of) in terms.iter().enumerate() {
        let name = |name: &str| format!("{key}[{index}].{name}");
        let of_wave = of.order.is_some() || of.amplitude.is_some() || of.phase.is_some();
        match (&of.values, of.amplitude) {
            (Some(_), _) if of_wave => {
                let why = "values make a curve, amplitude with order and phase a wave: one entry for each";
                return Err(SceneError::conflict(name("values"), why));
            }
            (None, None) => {
                let why =
                    "it needs amplitude (with order and phase), or values of a curve at equal distances";
                return Err(SceneError::conflict(format!("{key}[{index}]"), why));
            }
            (Some(values), _) => {
                POINTS.check(&format!("{}: number of points", name("values")), values.len() as f64)?;
                values.iter().try_for_each(|value| range.check(&name("values"), value.si()))?;
            }
            (None, Some(amplitude)) => {
                range.check(&name("amplitude"), amplitude.si())?;
                ORDER.check(&name("order"), f64::from(of.order.unwrap_or(1)))?;
                PHASE.check(&name("phase"), of.phase.map_or(0.0, |phase| phase.0))?;
            }
        }
    }
    Ok(())
}

/// Checks what varies: teeth that carry less than nothing are none.
fn check_varying(section: &MeshSection) -> Result<(), SceneError> {
    let terms: &[Varies<Ratio>] = &section.stiffness_variation;
    check_terms("mesh.stiffness_variation", terms, &OF_STIFFNESS)?;
    check_terms("mesh.transmission_error", &section.transmission_error, &ERROR)?;
    let [one, other] = teeth(section);
    let least = variation(terms, [one, other]).least(other.abs() / one);
    if least < -1.0 {
        let why = format!(
            "the stiffness comes down to {:.4} of its mean: allowed is 0 and more (a curve swings beyond its points where they jump)",
            1.0 + least
        );
        return Err(SceneError::conflict("mesh.stiffness_variation", why));
    }
    Ok(())
}

fn across(shafts: &[ShaftSection], [one, other]: [usize; 2]) -> Vector3<f64> {
    let [from, to] = [one, other].map(|shaft| Vector3::from(shafts[shaft].place(0.0)));
    Vector3::new(0.0, to.y - from.y, to.z - from.z)
}

/// \[m] ends of the common face width along x, in the axes of all shafts.
fn common_face(section: &MeshSection, shafts: &[ShaftSection], of: [usize; 2]) -> [f64; 2] {
    let ends = [0, 1].map(|k| {
        let gear = &section.gears[k];
        let middle = shafts[of[k]].place(gear.position.0)[0];
        [middle - 0.5 * gear.face_width.0, middle + 0.5 * gear.face_width.0]
    });
    [ends[0][0].max(ends[1][0]), ends[0][1].min(ends[1][1])]
}

fn pair(section: &MeshSection, shafts: &[ShaftSection], of: [usize; 2]) -> GearPair {
    let [from, to] = common_face(section, shafts, of);
    let signed = teeth(section);
    GearPair {
        module: section.normal_module.0,
        pressure_angle: section.pressure_angle.map_or(20f64.to_radians(), |angle| angle.0),
        helix_angle: section.helix_angle.map_or(0.0, |angle| angle.0),
        gears: [0, 1].map(|k| Gear {
            teeth: signed[k],
            profile_shift: section.gears[k].profile_shift,
            tip_diameter: section.gears[k].tip_diameter.map(|diameter| diameter.0),
        }),
        centre_distance: across(shafts, of).norm() * (signed[0] + signed[1]).signum(),
        face_width: to - from,
    }
}

/// Reads a mesh between these shafts.
///
/// # Errors
/// Names it, the key, the value and the range.
pub fn read(section: MeshSection, shafts: &[ShaftSection]) -> Result<SceneMesh, SceneError> {
    let name = section.name.clone();
    let inside = |source| SceneError::At { place: format!("mesh \"{name}\""), source: Box::new(source) };
    check(section, shafts).map_err(inside)
}

fn check(section: MeshSection, shafts: &[ShaftSection]) -> Result<SceneMesh, SceneError> {
    MODULE.check("mesh.normal_module", section.normal_module.0)?;
    PRESSURE_ANGLE.check("mesh.pressure_angle", section.pressure_angle.map_or(0.3, |angle| angle.0))?;
    HELIX_ANGLE.check("mesh.helix_angle", section.helix_angle.map_or(0.0, |angle| angle.0))?;
    section.stiffness.iter().try_for_each(|k| STIFFNESS.check("mesh.stiffness", k.0))?;
    section.damping_ratio.iter().try_for_each(|ratio| RATIO.check("mesh.damping_ratio", *ratio))?;
    section.backlash.iter().try_for_each(|play| PLAY.check("mesh.backlash", play.0))?;
    section.friction.iter().try_for_each(|friction| FRICTION.check("mesh.friction", *friction))?;
    let mut of = [0; 2];
    for (place, gear) in of.iter_mut().zip(&section.gears) {
        POSITION.check("mesh.gears.position", gear.position.0)?;
        TEETH.check("mesh.gears.teeth", f64::from(gear.teeth))?;
        WIDTH.check("mesh.gears.face_width", gear.face_width.0)?;
        SHIFT.check("mesh.gears.profile_shift", gear.profile_shift)?;
        *place = shafts.iter().position(|shaft| shaft.name == gear.shaft).ok_or_else(|| {
            let names: Vec<&str> = shafts.iter().map(|shaft| shaft.name.as_str()).collect();
            let why = format!("there is no such [[shaft]]; there are: {}", names.join(", "));
            SceneError::conflict(format!("mesh.gears.shaft = \"{}\"", gear.shaft), why)
        })?;
    }
    if of[0] == of[1] {
        return Err(SceneError::conflict(
            "mesh.gears.shaft",
            "both gears are on one shaft: each needs its own",
        ));
    }
    let [one, other] = teeth(&section);
    if one < 0.0 || one + other == 0.0 || (other < 0.0 && one + other > 0.0) {
        let why = format!(
            "inside teeth are those of the second gear, and there are more of them than the first one has: {} and {}",
            section.gears[0].teeth, section.gears[1].teeth
        );
        return Err(SceneError::conflict("mesh.gears.inside", why));
    }
    check_varying(&section)?;
    let pair = pair(&section, shafts, of);
    if pair.face_width.is_nan() || pair.face_width <= 0.0 {
        let why = "the teeth of both gears do not meet: their face widths have nothing in common";
        return Err(SceneError::conflict("mesh.gears.position", why));
    }
    let (distance, play) = (pair.centre_distance.abs(), pair.backlash());
    if play.is_nan() || play.abs() > FITS * pair.module {
        let why = format!(
            "the axes are {distance} m apart, which leaves a play of {play:.3e} m between teeth of these profile shifts: allowed is up to \
             {} m either way",
            FITS * pair.module
        );
        return Err(SceneError::conflict("shaft.origin", why));
    }
    if pair.contact_ratio().is_nan() || pair.contact_ratio() <= 0.5 {
        let why =
            format!("the contact ratio is {:.3}: the teeth do not reach each other", pair.contact_ratio());
        return Err(SceneError::conflict("mesh.gears", why));
    }
    Ok(SceneMesh { section, shafts: of, turned: 0.0 })
}

/// The train that each shaft is in: its first shaft, and the turns of this one for one of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InTrain {
    /// Index of the shaft that turns the others: one at a given speed, or with a speed at the start, or the first one.
    pub root: usize,
    /// [-] turns for one of that.
    pub ratio: f64,
}

/// Turns of a shaft for one of another, which teeth or a coupling tie to it.
struct Tie {
    shafts: [usize; 2],
    ratio: f64,
}

fn ties(meshes: &[SceneMesh], springs: &[SceneSpring]) -> Vec<Tie> {
    let of_teeth = meshes.iter().map(|mesh| Tie { shafts: mesh.shafts, ratio: mesh.ratio() });
    let couplings = springs.iter().filter_map(SceneSpring::couples);
    of_teeth.chain(couplings.map(|shafts| Tie { shafts, ratio: 1.0 })).collect()
}

/// The trains of all shafts.
pub fn trains(shafts: &[ShaftSection], meshes: &[SceneMesh], springs: &[SceneSpring]) -> Vec<InTrain> {
    let ties = ties(meshes, springs);
    let rank = |shaft: &ShaftSection| match shaft {
        one if one.speed.is_some() => 0.0,
        one if one.start_speed.is_some() => 1.0,
        _ => 2.0,
    };
    let ranks: Vec<f64> = shafts.iter().map(rank).collect();
    let mut found: Vec<Option<InTrain>> = vec![None; shafts.len()];
    for root in ascending(&ranks) {
        if found[root].is_some() {
            continue;
        }
        found[root] = Some(InTrain { root, ratio: 1.0 });
        let mut open = vec![root];
        while let Some(shaft) = open.pop() {
            let own = found[shaft].map_or(1.0, |own| own.ratio);
            for Tie { shafts: [one, other], ratio } in &ties {
                for (from, to, by) in [(*one, *other, *ratio), (*other, *one, 1.0 / ratio)] {
                    if from == shaft && found[to].is_none() {
                        found[to] = Some(InTrain { root, ratio: own * by });
                        open.push(to);
                    }
                }
            }
        }
    }
    found.into_iter().flatten().collect()
}

/// Refuses speeds that meshes and couplings do not allow.
///
/// # Errors
/// Names the shaft.
pub fn check_trains(
    shafts: &[ShaftSection],
    meshes: &[SceneMesh],
    springs: &[SceneSpring],
) -> Result<(), SceneError> {
    let trains = trains(shafts, meshes, springs);
    for (shaft, own) in shafts.iter().zip(&trains) {
        let root = &shafts[own.root];
        let given = shaft.speed.is_some() || shaft.start_speed.is_some();
        if given && shaft.name != root.name {
            let why = format!(
                "follows from that of \"{}\" by the teeth between them: take it out, or give a torque",
                root.name
            );
            return Err(SceneError::conflict(format!("shaft \"{}\": the speed", shaft.name), why));
        }
    }
    // A mesh closes a ring of others where its ratio has to be theirs.
    let names = meshes.iter().map(|mesh| format!("mesh \"{}\"", mesh.section.name));
    let couplings = springs.iter().filter(|spring| spring.couples().is_some());
    let names = names.chain(couplings.map(|spring| format!("coupling \"{}\"", spring.name)));
    for (tie, name) in ties(meshes, springs).iter().zip(names) {
        let [one, other] = tie.shafts.map(|shaft| trains[shaft].ratio);
        if (one * tie.ratio / other - 1.0).abs() > 1e-12 {
            let why = "it does not allow the turns that the other meshes make";
            return Err(SceneError::conflict(name, why));
        }
    }
    Ok(())
}
