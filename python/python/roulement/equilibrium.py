"""Quasi-static equilibria."""

import json
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np


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
    report: dict
    """All of it as the command line prints it (`--json`)."""


def equilibrium(scene, gyroscopic="outer-race-control"):
    """Solves the quasi-static equilibrium of a scene at time 0.

    `gyroscopic` says how the gyroscopic moment of the balls is carried: by friction at the outer race alone
    ("outer-race-control"), at the inner one alone ("inner-race-control"), for each ball at the one where spin would cost more
    ("least-heat"), not at all ("none"), or by friction at both races ("friction"). Raises RuntimeError if there is
    none.
    """
    report = json.loads(scene._native.equilibrium(gyroscopic))
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
        report=report,
    )
