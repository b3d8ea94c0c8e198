"""What a wheel has to do where nothing but it is installed: run by scripts/wheels, beside thrust.toml, with the folders of its platforms."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import roulement

scene = roulement.Scene.load("thrust.toml").with_({"load.duration": "2 ms"})
power = roulement.run(scene).mean("friction power")["mean"]
stiffness = roulement.equilibrium(roulement.catalogue.bearing("7206 B")).stiffness[0, 0]
print(f"friction power {power:.2f} W, axial stiffness of a 7206 B {stiffness * 1e-6:.0f} N/um")

package = roulement.package(scene, "trial.fmu")
folders = {Path(name).parts[1] for name in zipfile.ZipFile(package).namelist() if name.startswith("binaries/")}
print("package for", *sorted(folders), f"{package.stat().st_size * 1e-6:.1f} MB")
assert not sys.argv[1:] or folders == set(sys.argv[1:]), sys.argv
from roulement.coupling import WRENCH  # noqa: E402

from fmpy import simulate_fmu  # noqa: E402

result = simulate_fmu(str(package), stop_time=2**-10, output_interval=2**-13, output=WRENCH[:3])
simulation = roulement.Simulation(scene)
for _ in range(8):
    simulation.step(2**-13)
assert list(result[-1])[1:] == list(simulation["inner.force"]), (result[-1], simulation["inner.force"])
print("the package in FMPy has the bits of the simulation")

Path("cases.csv").write_text("friction.ball_race\n0.05\n0.1\n")
table = roulement.sweep.run("cases.csv", scene, "sweep")
assert set(table["status"]) == {"done"} and table["friction_power.mean"][0] < table["friction_power.mean"][1]
assert subprocess.run([sys.executable, "-m", "roulement.sweep", "--help"], capture_output=True).returncode == 0
# The program: on the path, of the same version, with the libraries of all platforms that the wheel has, and no compiler.
command = Path(sys.executable).with_name("roulement")
for start in ([command], [sys.executable, "-m", "roulement"]):
    version = subprocess.run([*start, "--version"], capture_output=True, text=True, check=True).stdout
    assert version.startswith(f"roulement {roulement.__version__} "), version
subprocess.run([command, "fmu", "thrust.toml", "-o", "all.fmu", "--name", "trial", "--all-platforms"], check=True, stdout=subprocess.DEVNULL)


def binaries(archive):
    with zipfile.ZipFile(archive) as of:
        return {name: of.read(name) for name in of.namelist() if name.startswith("binaries/")}


assert binaries("all.fmu") == binaries(package), "the program packs what Python packs"
subprocess.run([command, "run", "thrust.toml", "-o", "results"], check=True, stdout=subprocess.DEVNULL)
subprocess.run([command, "report", "results", "-o", "report.html"], check=True, stdout=subprocess.DEVNULL)
assert "</html>" in Path("report.html").read_text()[-100:]
print(f"the program has version {roulement.__version__}, makes packages, runs and pages")
guid = re.search('guid="([^"]*)"', roulement.Scene.load("thrust.toml").describe("thrust"))[1]
Path("found.txt").write_text(f"guid {guid}\n")
print("sweep done")
