"""First run: a scene with other keys, its equilibrium, its histories, its means. Usage: first_run.py [DIRECTORY]"""

import sys
from pathlib import Path

import roulement

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/python")
folder.mkdir(parents=True, exist_ok=True)
scene = roulement.Scene.load("scenes/thrust.toml").with_({"load.x.force": "2 kN", "load.duration": "5 ms"})

equilibrium = roulement.equilibrium(scene)
print(f"axial stiffness {equilibrium.stiffness[0, 0] * 1e-6:.0f} N/um, loads of balls {equilibrium.balls.inner_load.max():.0f} N")

results = roulement.run(scene, progress=True)
print(f"{len(results.time)} rows; force on the inner race at the end {results['inner.force'][-1]} N")
print(f"loads of balls {results['ball.inner.load'].min():.0f} to {results['ball.inner.load'].max():.0f} N")
power = results.mean("friction power")
print(f"friction power {power['mean']:.2f} +- {power['interval_95']:.2f} W, settled: {power['settled']}")
results.to_parquet(folder / "first_run.parquet")
