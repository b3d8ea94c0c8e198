"""What accuracy costs."""

import csv
from pathlib import Path

from . import _native
from .scene import Scene


def cost(scene, output, name="scene", threads=None):
    """Measures error against CPU time of every setting of a scene that trades accuracy for speed, as `roulement cost` does, into
    a directory. Takes minutes.

    Returns the rows of `cost.csv`, a dictionary each; plots and advice are beside it.
    """
    _native.cost(Scene.of(scene)._native, name, Path(output), threads)
    with open(Path(output) / "cost.csv", newline="") as table:
        return list(csv.DictReader(table))
