"""Quasi-static equilibria."""

import json
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from .scene import Scene


@dataclass(frozen=True)
class Equilibrium:
    """Quasi-static solution of a scene at time 0. Components are x, y, z, about y, about z."""

    displacement: np.ndarray
    """Of the loaded race against the other one [m, m, m, rad, rad]."""
    load: np.ndarray
    """External load on the loaded race [N, N, N, N m, N m]; the bearing's force on it is the opposite."""
    stiffness: np.ndarray
    """Derivative of the load by the displacement (5 x 5) [N/m, N, N m/rad]."""
    race: str
    """The loaded race, `inner` or `outer`."""
    cage_speed: float
    """[rad/s]"""
    residual: float
    """Of the load [-]."""
    peak_pressure: float
    """Largest contact pressure [Pa]."""
    balls: SimpleNamespace
    """An array over the balls each: azimuth [rad], inner_load and outer_load [N], inner_contact_angle and outer_contact_angle [rad],
    inner_approach and outer_approach [m], centrifugal_force [N], gyroscopic_moment [N m], and others."""
    life: SimpleNamespace | None
    """L10r and modified [1e6 revolutions], equivalent_load [N], static_safety [-]; None without `[rating]`."""
    duty: dict | None
    """Life over the `[[duty]]` of the scene, as `rating` gives it; None where it has none."""
    fits: list | None
    """Of fits that are given by words, a dictionary for `least`, `mean` and `greatest` interference each; None where there are none."""
    report: dict
    """All of it as the command line prints it (`--json`)."""


@dataclass(frozen=True)
class MachineEquilibrium:
    """Shafts in balance on their bearings at time 0. Forces are those on the shaft, in its axes; stiffness is in the axes of each bearing."""

    bearings: dict
    """Of every bearing by its name: force, moment, displacement and tilt of the shaft there (x, y, z) [N, N m, m, rad], stiffness (6 x 6)
    [N/m, N, N m/rad], peak_pressure [Pa], friction_torque [N m], balls as in `Equilibrium`, life or None."""
    meshes: dict
    """Of every mesh by its name: force_on_first_gear (x, y, z) and normal_force [N]."""
    modes: list
    """Natural frequencies: frequency [Hz], damping [-], whirl, and where most of it is (`at`)."""
    critical_speeds: list
    """The same at every critical speed, with that speed [rad/s]."""
    duty: dict | None
    """Life over the `[[duty]]` of the scene, as `rating` gives it; None where it has none."""
    fits: list | None
    """Of bearings whose fits are given by words, a dictionary for `least`, `mean` and `greatest` interference each; None where there are none."""
    report: dict
    """All of it as the command line prints it (`--json`), with the Campbell table."""


def equilibrium(scene, gyroscopic=None):
    """Solves the quasi-static equilibrium of a scene, or of that of a file by its path, at time 0: an `Equilibrium` of a bearing, a `MachineEquilibrium` of shafts.

    `gyroscopic` says how the gyroscopic moment of the balls is carried: by friction at the outer race alone
    ("outer-race-control", as if not given), at the inner one alone ("inner-race-control"), for each ball at the one where spin would cost more
    ("least-heat"), not at all ("none"), or by friction at both races ("friction", on shafts the only one).
    Raises RuntimeError if there is none.
    """
    report = json.loads(Scene.of(scene)._native.equilibrium(gyroscopic))
    if "bearings" in report:
        return _of_machine(report)
    return Equilibrium(
        displacement=np.array([report["displacement"][of] for of in ("x", "y", "z", "ry", "rz")]),
        load=np.array([report["load"][of] for of in ("Fx", "Fy", "Fz", "My", "Mz")]),
        stiffness=np.array(report["stiffness"]),
        race=report["race"],
        cage_speed=report["cage_speed"],
        residual=report["residual"],
        peak_pressure=report["peak_pressure"],
        balls=SimpleNamespace(**{name: np.array(values) for name, values in report["balls"].items()}),
        life=SimpleNamespace(**report["life"]) if "life" in report else None,
        duty=report.get("duty"),
        fits=report.get("fits"),
        report=report,
    )


def rating(scene, loads=None, runs=False):
    """Life of bearings over the `[[duty]]` of a scene, or under the loads of a table, the path of a CSV or TOML file with a column `share`
    and keys of the scene (docs/load-cases.md): an equilibrium under each load, or with `runs` a run of its `load.duration`, added up by Miner's rule.

    A dictionary: `hours` of the whole duty, where its parts are hours; `loads`, a list with `name`, `share`, `bearings` and `machine` each; and what all loads
    come to, `bearings` and `machine`. A bearing, by its name (that of a bearing alone is empty), has `speed` [rad/s], `equivalent_load` [N], `L10r`
    and `modified` [1e6 revolutions], `L10r_hours` and `modified_hours` [h], `static_safety`, `friction_torque` [N m], `loss` [W], `damage` [-], and,
    under all loads, `worst`: the `load` that takes most of its life, and the part `taken`. Raises ValueError if a load is refused or there are none,
    RuntimeError if one has no equilibrium or its run fails.
    """
    return json.loads(Scene.of(scene)._native.rating(None if loads is None else Path(loads), runs))


def _of_machine(report):
    def bearing(of):
        vectors = {name: np.array([of[name][axis] for axis in "xyz"]) for name in ("force", "moment", "displacement", "tilt")}
        balls = SimpleNamespace(**{name: np.array(values) for name, values in of["balls"].items()})
        life = SimpleNamespace(**of["life"]) if of["life"] else None
        return SimpleNamespace(**{**of, **vectors, "stiffness": np.array(of["stiffness"]), "balls": balls, "life": life})

    return MachineEquilibrium(
        bearings={name: bearing(of) for name, of in report["bearings"].items()},
        meshes={
            name: SimpleNamespace(force_on_first_gear=np.array([of["force_on_first_gear"][axis] for axis in "xyz"]), normal_force=of["normal_force"])
            for name, of in report["meshes"].items()
        },
        modes=[SimpleNamespace(**mode) for mode in report["modes"]],
        critical_speeds=[SimpleNamespace(**critical) for critical in report["critical_speeds"]],
        duty=report.get("duty"),
        fits=report.get("fits"),
        report=report,
    )
