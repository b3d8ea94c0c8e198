from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from numpy.typing import ArrayLike, NDArray

# Matrices are arrays, or sparse ones of SciPy, which is not needed for arrays.
def reduce(
    mass: ArrayLike | Any,
    stiffness: ArrayLike | Any,
    interface: Sequence[int] | NDArray[Any],
    highest: float,
    gyroscopic: ArrayLike | Any | None = None,
) -> dict[str, NDArray[Any]]: ...
def write(
    path: str | PathLike[str],
    mass: ArrayLike,
    stiffness: ArrayLike,
    translations: ArrayLike | None,
    stations: Mapping[float, ArrayLike] | Mapping[tuple[float, float, float], ArrayLike],
    *,
    weights: ArrayLike | None = None,
    gyroscopic: ArrayLike | None = None,
    damping: ArrayLike | None = None,
    polar_inertia: float = 0.0,
    title: str = "",
) -> None: ...
def package(
    file: str | PathLike[str],
    path: str | PathLike[str],
    library: str | PathLike[str] | Sequence[str | PathLike[str]] | None = None,
    name: str | None = None,
    columns: Sequence[str] = (),
    fmi: int = 2,
) -> Path: ...
def write_ross(path: str | PathLike[str], rotor: Any, nodes: Sequence[int], highest: float) -> None: ...
