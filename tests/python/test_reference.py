"""Example FMUs with their reference results (`scripts/reference_results.py`): packages of both versions give what is kept, which is that of a native
run of the scene."""

import subprocess
import sys

import numpy as np
from conftest import ROOT, roulement

sys.path.insert(0, str(ROOT / "scripts"))
import reference_results as reference  # noqa: E402


def test_packages_of_both_versions_give_the_reference_results(tmp_path):
    run = subprocess.run([sys.executable, ROOT / "scripts" / "reference_results.py", tmp_path], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.count("of what is allowed from the reference") == 2 * len(reference.EXAMPLES) >= 6
    for version, (_, folder) in reference.VERSIONS.items():
        for name, example in reference.EXAMPLES.items():
            (place,) = (tmp_path / "fmus" / version / "cs" / folder / "roulement").glob(f"*/{name}")
            files = {"README.md", f"{name}.fmu", f"{name}_in.csv", f"{name}_ref.csv", f"{name}_ref.opt"}
            assert {path.name for path in place.iterdir()} == files
            # Rules of the lists.
            for ending in ["in", "ref"]:
                table = place / f"{name}_{ending}.csv"
                names, rows = reference.read_csv(table)
                assert names[0] == "time" and np.all(np.diff(rows[:, 0]) >= 0) and table.stat().st_size < 1e6
                assert table.read_text().startswith('"time",') and len(names) <= 11
                assert rows[0, 0] == 0 and abs(rows[-1, 0] - example["stop"]) < 1e-9
                # Everything in it moves.
                assert np.all(np.ptp(rows, axis=0) > 0), (name, ending, names)


def test_a_changed_result_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(reference, "KEPT", tmp_path)
    package = tmp_path / "speed_ramp.fmu"
    roulement("fmu", ROOT / reference.EXAMPLES["speed_ramp"]["scene"], "-o", package)
    reference.keep("speed_ramp", package)
    assert reference.deviation("speed_ramp", package) < 1e-3
    names, rows = reference.read_csv(tmp_path / "speed_ramp_ref.csv")
    rows[100, 2] *= 1.001
    reference.write_csv(tmp_path / "speed_ramp_ref.csv", names, rows)
    assert reference.deviation("speed_ramp", package) > 1.0


def test_a_native_run_of_the_scene_is_that_of_a_step_before(tmp_path):
    """The run-up is in the scene as a table, too, which a native run plays as it is; a package goes to an input within the step that follows."""
    example = reference.EXAMPLES["speed_ramp"]
    columns = ",".join(example["outputs"])
    roulement("run", ROOT / example["scene"], "-o", tmp_path, "--columns", columns, "--steps-end-at-rows")
    with (tmp_path / "results.csv").open() as file:
        names = [name.split(" [")[0] for name in file.readline().strip().split(",")]
        rows = np.loadtxt(file, delimiter=",")
    _, kept = reference.read_csv(reference.KEPT / "speed_ramp_ref.csv")
    for index, name in enumerate(example["outputs"]):
        native, given = rows[: len(kept) - 1, names.index(name)], kept[1:, 1 + index]
        assert np.abs(native - given).max() < 1e-5 * np.abs(native).max(), name
