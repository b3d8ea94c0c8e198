from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

ACCELERATION_REFERENCE: float
VELOCITY_REFERENCE: float

@dataclass(frozen=True)
class Levels:
    rms: float
    peak: float
    crest_factor: float
    kurtosis: float
    velocity_rms: float
    @property
    def decibel(self) -> float: ...
    @property
    def velocity_decibel(self) -> float: ...

@dataclass(frozen=True)
class Spectrum:
    frequency: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    band: tuple[float, float] | None = None
    def at(self, frequency: float, width: float | None = None) -> float: ...

def levels(time: ArrayLike, acceleration: ArrayLike, band: tuple[float, float] = (10.0, 1000.0)) -> Levels: ...
def loudest_band(time: ArrayLike, signal: ArrayLike, lowest: float = 0.0) -> tuple[float, float]: ...
def envelope(time: ArrayLike, signal: ArrayLike, band: tuple[float, float] | None = None) -> Spectrum: ...
def orders(angle: ArrayLike, signal: ArrayLike, per_turn: int | None = None) -> Spectrum: ...
