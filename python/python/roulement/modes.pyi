from os import PathLike
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .scene import Scene

@dataclass(frozen=True)
class Motions:
    speed: float
    after: float
    frequency: NDArray[np.float64]
    growth: NDArray[np.float64]
    growth_spread: NDArray[np.float64]
    damping: NDArray[np.float64]
    balls: NDArray[np.float64]
    grows: NDArray[np.bool_]
    shape: list[str]
    error: str | None

@dataclass(frozen=True)
class Modes:
    own: Motions
    speeds: list[Motions]
    report: dict[str, Any]

def modes(
    scene: Scene | str | PathLike[str], time: float = 0.0, after: float = 2e-3, up_to: float | None = None, speeds: int = 12
) -> Modes: ...
