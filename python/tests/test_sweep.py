"""Sweeps from Python: the same files as the command line's, on threads (test_cluster.py: on Dask)."""

import numpy as np
import pytest
import roulement
from conftest import ROOT, cases, instance_of, program
from roulement import sweep

FRICTION = [0.05, 0.08, 0.11]


def test_consistency_files_are_those_of_the_command_line(tmp_path):
    path, scene = tmp_path / "cases.csv", ROOT / "scenes" / "thrust.toml"
    path.write_text(cases(4, "1 ms") + "-1,1 ms\n")
    ended = program("sweep", path, "--scene", scene, "-o", tmp_path / "program", "--columns", "inner.position.x", check=False)
    assert ended.returncode == 4, "a case has failed"
    table = sweep.run(path, scene, tmp_path / "python", columns="inner.position.x", workers=2)
    assert (tmp_path / "program" / "summary.csv").read_bytes() == (tmp_path / "python" / "summary.csv").read_bytes()
    assert len(table) == 5 and list(table["status"]) == ["done"] * 4 + ["failed"]
    assert "friction.ball_race = -1" in table["reason"][4]
    assert table.units["friction_power.mean"] == "W" and np.isnan(table["friction_power.mean"][4])
    assert (np.diff(table["friction_power.mean"][:4]) > 0).all()
    means = roulement.run(roulement.Scene.load(scene).with_({"friction.ball_race": 0.04, "load.duration": "1 ms"})).mean("friction power")
    assert table["friction_power.mean"][0] == means["mean"]


def test_lists_and_dictionaries_are_cases(tmp_path, thrust):
    short = thrust.with_({"load.duration": "0.2 ms"})
    one = sweep.run({"friction.ball_race": FRICTION, "load.x": [{"force": 500.0}, {"force": "1 kN"}]}, short, tmp_path / "grid")
    assert len(one) == 6 and set(one["status"]) == {"done"}
    rows = [{"friction.ball_race": mu, "load": {"x": {"force": force}}} for mu in FRICTION for force in ("500 N", "1 kN")]
    other = sweep.run(rows, short, tmp_path / "list", progress=False)
    assert np.array_equal(one["friction_power.mean"], other["friction_power.mean"])
    with pytest.raises(ValueError, match="friction.bal_race"):
        sweep.run([{"friction.bal_race": 0.1}], short, tmp_path / "wrong")


def test_consistency_growth_is_that_of_the_command_line(tmp_path):
    path, scene = tmp_path / "cases.csv", ROOT / "scenes" / "thrust.toml"
    path.write_text(cases(2, "0.2 ms"))
    program("sweep", path, "--scene", scene, "-o", tmp_path / "program", "--growth")
    table = sweep.run(path, scene, tmp_path / "python", workers=2, growth=True)
    assert (tmp_path / "program" / "summary.csv").read_bytes() == (tmp_path / "python" / "summary.csv").read_bytes()
    assert set(table["grows"]) <= {"yes", "no"} and table.units["growth"] == "1/s"
    assert np.isfinite(table["growth"]).all() and (table["growth.frequency"] >= 0).all() and all(table["growth.motion"])
    # Cases of the same directory without it are others, and have no such columns.
    assert "grows" not in sweep.run(path, scene, tmp_path / "python").names


def test_consistency_the_same_cases_in_fmpy_have_the_same_numbers_but_for_the_error_of_steps(tmp_path, thrust):
    interval, rows = 1e-4, 20
    base = thrust.with_({"load.output_interval": interval, "load.duration": interval * rows, "effects.per_ball_outputs": True})
    cases = [{"friction.ball_race": mu, "load.x.force": force} for mu in (0.05, 0.1) for force in ("1 kN", "2 kN")]
    cases += [{"outer.misalignment.rz": "1 mrad", "bearing.inner_conformity": 0.53}]
    columns = ["inner.force.x", "ball[1].inner.load", "ball[10].outer.contact_angle"]
    table = sweep.run(cases, base, tmp_path / "sweep", columns=columns)
    assert set(table["status"]) == {"done"}
    for k, case in enumerate(cases):
        fmu, references = instance_of(roulement.package(base.with_(case), tmp_path / f"case_{k}.fmu"))
        wanted = [references[name] for name in columns]
        values = [fmu.getReal(wanted)]
        for row in range(rows):
            fmu.doStep(row * interval, interval)
            values.append(fmu.getReal(wanted))
        for name, column in zip(columns, np.array(values).T):
            of = {kind: table[f"{name}.{kind}"][k] for kind in ("mean", "least", "largest", "end")}
            # A package ends a step at every point of communication, a sweep where the motion wants it: both are within the error of steps,
            # which is 2 % of a course as long as no error goal asks for less.
            swing = np.ptp(column)
            of_steps = 0.02 * swing
            assert abs(of["end"] - column[-1]) <= of_steps, (case, name, of, column[-1])
            # A sweep sees all steps, a master the points at which it asks.
            assert column.min() - swing <= of["least"] <= column.min() + of_steps, (case, name, of, column.min())
            assert column.max() - of_steps <= of["largest"] <= column.max() + swing, (case, name, of, column.max())
            # A mean is an integral over time of the second half: between the sums over rows from below and above, of what steps see.
            second = column[rows // 2 :]
            assert abs(of["mean"] - np.trapezoid(second) / (len(second) - 1)) < 0.5 * np.ptp(second), (case, name, of)
        fmu.freeInstance()
