from dataclasses import dataclass
from os import PathLike
from typing import Any, Callable, Literal, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from . import sweep
from .scene import Scene

Ranges = Mapping[str, tuple[float | str, float | str]]
Cases = list[dict[str, float | str]]

def sobol(ranges: Ranges, count: int, seed: int = 0) -> Cases: ...
def latin_hypercube(ranges: Ranges, count: int, seed: int = 0) -> Cases: ...
@dataclass(frozen=True)
class Sensitivity:
    method: str
    keys: list[str]
    strength: dict[str, NDArray[np.float64]]
    error: dict[str, NDArray[np.float64]]
    table: sweep.Table | None = None
    def plot(self, path: str | PathLike[str]) -> None: ...

def sensitivity_of(
    function: Callable[[Cases], dict[str, Any]],
    ranges: Ranges,
    method: Literal["morris", "sobol"] = "morris",
    count: int = 16,
    seed: int = 0,
) -> Sensitivity: ...
def sensitivity(
    scene: Scene,
    ranges: Ranges,
    results: Sequence[str],
    output: str | PathLike[str],
    method: Literal["morris", "sobol"] = "morris",
    count: int = 16,
    seed: int = 0,
    **options: Any,
) -> Sensitivity: ...
