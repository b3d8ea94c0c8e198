import numpy as np
from numpy.typing import ArrayLike, NDArray

LAWS: tuple[str, ...]

def contact(
    law: str,
    *,
    peak_pressure: ArrayLike,
    semi_axis_x: ArrayLike,
    semi_axis_y: ArrayLike,
    creep_x: ArrayLike = 0.0,
    creep_y: ArrayLike = 0.0,
    spin: ArrayLike = 0.0,
    friction: ArrayLike = 0.08,
    shear_modulus: ArrayLike = 79.3e9,
    poisson_ratio: ArrayLike = 0.3,
    rolling_angle: ArrayLike = 0.0,
    curvature: ArrayLike = 0.0,
    degree: int = 5,
    grid: int = 16,
) -> dict[str, NDArray[np.float64]]: ...
