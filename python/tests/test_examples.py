"""Every example runs and says what it found; every block of the documents runs; stubs name what there is."""

import ast
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import PROGRAM, ROOT

EXAMPLES = {
    "first_run": ["axial stiffness", "friction power", "settled"],
    "misalignment_map": ["rating life L10", "friction power"],
    "two_bearing_shaft": ["tilt"],
    "friction_map": ["kalker_table"],
    "surrogate": ["largest error"],
    "dry_running": ["friction 0.3, 8 um, 3.0 W/K: clearance", "4.2 GPa"],
    "ross_rotor": ["radial stiffness", "18000 rpm"],
}
ENVIRONMENT = {**os.environ, "ROULEMENT_BIN": str(PROGRAM)}


def python(*arguments):
    """Runs Python in the project's folder."""
    ended = subprocess.run([sys.executable, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True, env=ENVIRONMENT)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def test_all_examples_are_here_and_short():
    files = list((ROOT / "examples" / "python").glob("*.py"))
    assert {file.stem for file in files} == set(EXAMPLES)
    assert all(len(file.read_text().splitlines()) < 40 for file in files)


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs(name, tmp_path):
    if name == "ross_rotor" and importlib.util.find_spec("ross") is None:
        pytest.skip("ROSS is not installed (examples/python/ross-requirements.txt)")
    said = python(ROOT / "examples" / "python" / f"{name}.py", tmp_path)
    assert all(part in said for part in EXAMPLES[name]), said
    if name == "surrogate":
        # Between 256 equilibria a smooth function of three displacements is known well.
        assert float(re.search(r"error (\S+) of", said)[1]) < 0.02
    if name == "ross_rotor":
        # Centrifugal force of the balls takes stiffness, and the rotor's modes with it.
        at_rest, fast = map(float, re.search(r"stiffness (\S+) N/um at rest, (\S+) at", said).groups())
        assert at_rest > 2 * fast > 0
        both = [[float(part.split()[0]) for part in line.split("[")[1:]] for line in said.splitlines() if "bending" in line]
        assert both[0][0] == both[0][1] and both[2][0] < 0.9 * both[2][1], both
    if name == "misalignment_map":
        # Misalignment and thrust take life by more than an order of magnitude.
        low, high = map(float, re.search(r"revolutions\]: (\S+) to (\S+)", said).groups())
        assert high > 10 * low > 0


def test_closed_form_the_gearbox_has_the_forces_of_statics(tmp_path):
    said = python(ROOT / "examples" / "gearbox" / "gearbox.py", tmp_path, 30)
    rows = [line.strip("|").split("|") for line in said.splitlines() if line.startswith("| aligned")]
    assert [row[1].strip() for row in rows] == ["left", "right"], said
    for row in rows:
        radial, by_hand = map(float, row[2].split(","))
        assert abs(radial / by_hand - 1) < 0.01, said
    left, right = (float(row[3]) for row in rows)
    # The mesh pushes with the torque over the pitch radius, times the tangent of the helix angle.
    assert abs((left - right) / (30.0 / 0.0238 * np.tan(np.radians(15))) - 1) < 0.01, said
    table = np.genfromtxt(tmp_path / "gearbox.csv", delimiter=",", names=True)
    assert len(table) == 750 and np.isfinite(table["time_s"]).all()
    # 30 ms is the first phase alone.
    assert_is_written("packages coupled", said, phases=1)


def test_the_gearbox_with_its_shaft_inside_is_that_of_its_page(tmp_path):
    assert_is_written("shaft inside", python(ROOT / "examples" / "gearbox" / "inside.py", tmp_path), phases=3)
    drawn = importlib.util.find_spec("matplotlib") is not None
    assert (tmp_path / "inside.png").exists() == drawn


def assert_is_written(name, said, phases):
    """Is the table that an example of the gearbox has printed that of docs/gearbox.md? Numbers within half a percent, or 1 in the last digit."""
    written = (ROOT / "docs" / "gearbox.md").read_text().split(f"<!-- begin {name} -->")[1].split("<!-- end -->")[0]
    rows_of = lambda text: [line for line in text.splitlines() if line.startswith("| ") and not line.startswith("| phase")]
    rows, old = rows_of(said), rows_of(written)
    assert len(rows) == 2 * phases and len(old) == 6
    number = re.compile(r"\d+(?:\.\d+)?")
    for row, before in zip(rows, old):
        assert number.sub("", row) == number.sub("", before)
        for new, of in zip(number.findall(row), number.findall(before), strict=True):
            last = 0.1 if "." in of else 1
            assert abs(float(new) - float(of)) <= max(0.005 * float(of), 1.001 * last), f"docs/gearbox.md is out of date: {row} for {before}"


@pytest.mark.parametrize("document, least", [("docs/python.md", 5), ("README.md", 1), ("docs/masters/fmpy.md", 2)])
def test_blocks_of_the_documents_run(tmp_path, document, least):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / document).read_text(), re.DOTALL)
    assert len(blocks) >= least
    script = tmp_path / "blocks.py"
    script.write_text("\n".join(blocks).replace('"results/', f'"{tmp_path}/'))
    python(script)


def test_the_commands_of_the_readme_for_fmpy_run(tmp_path):
    """Those behind the installation, in a folder of their own. Other commands of the program run in `cli/tests`."""
    block = re.search(r"```sh\npip install fmpy\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
    assert len(block.splitlines()) == 2
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    folders = [str(PROGRAM.parent), str(Path(sys.executable).parent), os.environ["PATH"]]
    environment = {**ENVIRONMENT, "PATH": os.pathsep.join(folders)}
    ended = subprocess.run(["bash", "-euc", block], cwd=tmp_path, capture_output=True, text=True, env=environment)
    assert ended.returncode == 0, ended.stderr
    time, force = re.search(r"\((\S+), (\S+)\)\s*$", ended.stdout).groups()
    # Under 1.5 kN of thrust the bearing pushes back.
    assert float(time) == pytest.approx(2e-3) and abs(float(force)) == pytest.approx(1500, rel=0.2), ended.stdout


def test_stubs_name_what_there_is():
    import roulement

    folder = Path(roulement.__file__).parent
    assert (folder / "py.typed").exists()
    for stub in folder.glob("*.pyi"):
        module = stub.with_suffix(".py")
        if not module.exists():
            continue
        names = lambda path: {
            (node.name, of.name if of is not node else "")
            for node in ast.parse(path.read_text()).body
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_")
            for of in ([node] if isinstance(node, ast.FunctionDef) else [node, *node.body])
            if of is node or isinstance(of, ast.FunctionDef) and not of.name.startswith("_")
        }
        assert names(stub) == names(module), stub.name
