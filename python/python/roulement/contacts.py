"""Single rolling contacts."""

import numpy as np

from . import _native

LAWS = tuple(_native.laws())
"""Names of the creep laws: those of scenes from the poorest to the richest, then the half-space solver."""

_INPUTS = (
    "poisson_ratio",
    "shear_modulus",
    "friction",
    "peak_pressure",
    "semi_axis_x",
    "semi_axis_y",
    "rolling_angle",
    "creep_x",
    "creep_y",
    "spin",
    "curvature",
)


def contact(
    law,
    *,
    peak_pressure,
    semi_axis_x,
    semi_axis_y,
    creep_x=0.0,
    creep_y=0.0,
    spin=0.0,
    friction=0.08,
    shear_modulus=79.3e9,
    poisson_ratio=0.3,
    rolling_angle=0.0,
    curvature=0.0,
    degree=5,
    grid=16,
):
    """Forces of rolling contacts by a creep law (`LAWS`), as `roulement contact` evaluates them.

    Arguments are numbers or arrays that broadcast against each other: peak pressure [Pa], semi-axes [m], creepages [-], spin
    creepage [1/m], friction coefficient [-], shear modulus [Pa], Poisson's ratio [-], direction of rolling from the ellipse's x
    axis [rad], slip of a bent groove [1/m2]. `degree` is that of `kalker`, `grid` the cells of `reference`.

    Returns a dictionary of arrays: fx, fy over mu N, mz over mu N c, power over mu N V, and stick, the share of adhesion (nan
    where the law does not know it). Raises ValueError for numbers out of range, with the number of the contact.
    """
    given = locals()
    arrays = np.broadcast_arrays(*(np.asarray(given[name], dtype=float) for name in _INPUTS))
    shape = arrays[0].shape
    inputs = np.ascontiguousarray(np.stack([array.ravel() for array in arrays]))
    outputs = np.empty((5, inputs.shape[1]))
    if inputs.shape[1] > 0:
        _native.contact(law, degree, grid, inputs, outputs)
    return {name: row.reshape(shape) for name, row in zip(("fx", "fy", "mz", "power", "stick"), outputs)}
