"""How long a bearing runs after its oil is lost, over friction, clearance and the way that heat takes. Usage: dry_running.py [DIRECTORY [DURATION]]"""

import itertools
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import roulement

FASTER = 400.0  # everything warms so much faster: 100 ms tell of 40 s
LOST = 0.02  # [s] the oil is gone
HOT = 60.0  # [K] rise over 60 degC up to which steel of usual heat treatment keeps its hardness (120 degC)
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/python")
limits = {"clearance": lambda run: run["clearance"] <= 0, "4.2 GPa": lambda run: run["ball.inner.peak_pressure"].max(axis=1) >= 4.2e9,
          f"{HOT:.0f} K": lambda run: run["temperature_rise.inner"] >= HOT}
scene = roulement.Scene.load(Path(__file__).parents[2] / "scenes" / "effects" / "loss_of_lubrication.toml").with_({
    "load.duration": sys.argv[2] if len(sys.argv) > 2 else "120 ms", "film.lubrication": [[0.0, 1.0], [0.01, 1.0], [LOST, 0.0]]})


def times(case):
    """[s] from the loss of the oil until each limit, infinite where the run ends before."""
    friction, clearance, path = case
    changed = scene.with_({"friction.ball_race": friction, "bearing.diametral_clearance": clearance, "effects.heat_balance.inner_shaft": path})
    run = roulement.run(changed, columns=["clearance", "temperature_rise.inner", "ball[*].inner.peak_pressure"])
    met = {name: np.flatnonzero(reached(run)) for name, reached in limits.items()}
    return {name: FASTER * (run.time[at[0]] - LOST) if len(at) else np.inf for name, at in met.items()}


# Coefficient of dry steel, clearance [m], W/K from the inner ring to its shaft.
cases = list(itertools.product([0.2, 0.3], [8e-6, 16e-6], [0.5, 3.0]))
folder.mkdir(parents=True, exist_ok=True)
with ThreadPoolExecutor() as pool, (folder / "dry_running.csv").open("w") as table:
    print("friction", "clearance [m]", "inner_shaft [W/K]", *(f"{name} [s]" for name in limits), sep=",", file=table)
    for (friction, clearance, path), found in zip(cases, pool.map(times, cases)):
        told = ", ".join(f"{name} {f'{time:.0f} s' if np.isfinite(time) else 'never'}" for name, time in found.items())
        print(friction, clearance, path, *found.values(), sep=",", file=table)
        print(f"friction {friction}, {1e6 * clearance:.0f} um, {path} W/K: {told}")
