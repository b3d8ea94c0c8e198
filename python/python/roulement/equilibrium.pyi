from os import PathLike
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .scene import Scene

@dataclass(frozen=True)
class Equilibrium:
    displacement: NDArray[np.float64]
    load: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    race: str
    cage_speed: float
    residual: float
    peak_pressure: float
    balls: SimpleNamespace
    life: SimpleNamespace | None
    duty: dict[str, Any] | None
    fits: list[dict[str, Any]] | None
    report: dict[str, Any]

@dataclass(frozen=True)
class MachineEquilibrium:
    bearings: dict[str, SimpleNamespace]
    meshes: dict[str, SimpleNamespace]
    modes: list[SimpleNamespace]
    critical_speeds: list[SimpleNamespace]
    duty: dict[str, Any] | None
    fits: list[dict[str, Any]] | None
    report: dict[str, Any]

def equilibrium(
    scene: Scene | str | PathLike[str],
    gyroscopic: Literal["outer-race-control", "inner-race-control", "least-heat", "none", "friction"] | None = None,
) -> Equilibrium | MachineEquilibrium: ...
def rating(scene: Scene | str | PathLike[str], loads: str | PathLike[str] | None = None, runs: bool = False) -> dict[str, Any]: ...
