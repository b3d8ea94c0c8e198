"""A ball bearing in three dimensions: equilibria, dynamic runs, sweeps and FMI packages.

>>> import roulement
>>> scene = roulement.Scene.load("scenes/thrust.toml").with_({"load.x.force": "2 kN", "load.duration": "2 ms"})
>>> results = roulement.run(scene)
>>> results["inner.force"].shape       # rows, components x y z [N]
(21, 3)

All numbers are SI, angles in radians. Results have the same bits as those of the command line.
"""

import importlib
import importlib.metadata

from . import catalogue, coupling, load_cases, shaft, vibration
from .contacts import LAWS, contact
from .cost import cost
from .equilibrium import Equilibrium, MachineEquilibrium, equilibrium, rating
from .modes import Modes, Motions, modes
from .results import Results, run
from .scene import Checked, Scene, cage, check, effects, package
from .simulation import Simulation

__all__ = [
    "LAWS",
    "Checked",
    "Equilibrium",
    "MachineEquilibrium",
    "Modes",
    "Motions",
    "Results",
    "Scene",
    "Simulation",
    "cage",
    "catalogue",
    "check",
    "contact",
    "cost",
    "coupling",
    "design",
    "effects",
    "equilibrium",
    "load_cases",
    "modes",
    "package",
    "rating",
    "run",
    "shaft",
    "sweep",
    "vibration",
]


def __getattr__(name):
    # Not before they are used: `python -m roulement.sweep` runs one of them itself.
    if name in ("design", "sweep"):
        return importlib.import_module(f".{name}", __name__)
    if name == "__version__":
        return importlib.metadata.version(__name__)
    raise AttributeError(f"module {__name__} has no attribute {name}")
