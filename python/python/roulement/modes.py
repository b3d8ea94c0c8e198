"""Small motions about the running state, over the speed."""

import json
import math
from dataclasses import dataclass

import numpy as np

from . import _native
from .scene import Scene


@dataclass(frozen=True)
class Motions:
    """Motions at a speed, by growing frequency: arrays with an entry for each of them."""

    speed: float
    """Of the shaft, or of the race that turns fastest [rad/s]."""
    after: float
    """How long the machine ran before its motions were looked at first, and again until they were last [s]."""
    frequency: np.ndarray
    """[Hz]"""
    growth: np.ndarray
    """Mean over the moments; negative where it decays [1/s]."""
    growth_spread: np.ndarray
    """Half the range of the growth over these moments; nan where the motion was not there at one of them [1/s]."""
    damping: np.ndarray
    """Over critical damping [-]."""
    balls: np.ndarray
    """Share of the balls in the kinetic energy, spins left out [-]."""
    grows: np.ndarray
    """Does it grow at all of these moments?"""
    shape: list
    """What moves, and how, in words."""
    error: str | None
    """Why there are none; None where they were found."""


@dataclass(frozen=True)
class Modes:
    """Small motions of a machine over its speed."""

    own: Motions
    """At the speed of the scene."""
    speeds: list
    """`Motions` at other speeds, by growing speed; none where nothing turns."""
    report: dict
    """All of it as the command line prints it (`--json`)."""


def _motions(row):
    found = row["motions"] or []
    array = lambda name: np.array([math.nan if motion[name] is None else motion[name] for motion in found], dtype=float)
    return Motions(
        speed=row["speed"],
        after=row["after"],
        frequency=array("frequency"),
        growth=array("growth"),
        growth_spread=array("growth_spread"),
        damping=array("damping"),
        balls=array("balls"),
        grows=np.array([motion["grows"] for motion in found], dtype=bool),
        shape=[motion["shape"] for motion in found],
        error=row["error"],
    )


def modes(scene, time=0.0, after=2e-3, up_to=None, speeds=12):
    """Finds the small motions of rings, shafts, housings and cage about the running state, as `roulement modes` does: which grow, which decay.

    The scene is a bearing, or a shaft with its bearings. `time` is that of its scripts [s], `after` how long it runs at each speed before its
    motions are looked at [s]. The table has `speeds` speeds up to `up_to` [rad/s], 1.5 times that of the scene if not given.

    Raises ValueError for a number out of range, RuntimeError if the machine cannot start or run at its own speed.
    """
    limit = None if up_to is None else float(up_to)
    report = json.loads(_native.modes(Scene.of(scene)._native, float(time), float(after), limit, speeds))
    return Modes(own=_motions(report["own"]), speeds=[_motions(row) for row in report["speeds"]], report=report)
