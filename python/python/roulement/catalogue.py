"""Catalogue bearings as scenes: internal geometry estimated from dimensions and load ratings (docs/catalogue.md).

>>> scene = bearing("6205 C3").with_({"load.y.force": "2 kN"})
>>> candidates("6205")[0]["balls"]
9

A bearing is a name as on the box ("6205", "SKF 6305-2RS1/C3", "7206BECBP", "6805"), or numbers in SI or texts with a unit: `bore`, `outside`,
`width` [m], `dynamic_load_rating`, `static_load_rating` [N], `contact_angle` [rad] (0, a deep-groove bearing, if not given). Numbers
beside a name stand in place of those of the table. `clearance` is the class of a deep-groove bearing, "C2" to "C5"; `cage` is "ideal" (if not given), "estimated" or "none".
"""

import json
from pathlib import Path

from . import _native
from ._toml import to_toml
from .scene import Scene

KEYS = ("bore", "outside", "width", "dynamic_load_rating", "static_load_rating", "contact_angle", "clearance", "cage")


def _request(designation, numbers):
    for key in numbers:
        if key not in KEYS:
            raise TypeError(f"{key} is none of {', '.join(KEYS)}")
    given = {"designation": designation, **numbers}
    return "\n".join(f"{key} = {to_toml(value)}" for key, value in given.items() if value is not None)


def bearing(designation=None, *, candidate=1, shelf=None, **numbers):
    """The scene of a bearing, with the `candidate`-th balls that come near its load ratings. `Scene.source` has sources and spreads of
    all estimates in its comments, until the scene is edited. `shelf` is the path of a file of one's own bearings, which come before the table.

    Raises ValueError if a name is not in the table, something is missing or out of range.
    """
    return Scene.parse(_native.catalogue_scene(_request(designation, numbers), candidate, shelf and Path(shelf)))


def candidates(designation=None, *, shelf=None, **numbers):
    """Balls that come near both load ratings, the nearest first: a list of dictionaries with `balls`, `ball_diameter`,
    `pitch_diameter` [m], `inner_conformity`, `outer_conformity`, `dynamic_load_rating`, `static_load_rating` [N], their errors
    `dynamic_error`, `static_error` [-], and `inner_mass`, `outer_mass` of the rings [kg]."""
    return json.loads(_native.catalogue_candidates(_request(designation, numbers), shelf and Path(shelf)))


def names():
    """Names of the table of common sizes."""
    return _native.catalogue_names()
