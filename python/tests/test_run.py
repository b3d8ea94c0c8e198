"""Runs: the same bits as the command line, tables of other packages, threads, interruption."""

import json
import threading
import time

import numpy as np
import pytest
import roulement
from conftest import bits, program, table_of


@pytest.fixture
def printed(thrust, tmp_path):
    """Table and summary of the command line."""
    (tmp_path / "scene.toml").write_text(thrust.source)
    summary = json.loads(program("run", tmp_path / "scene.toml", "-o", tmp_path / "out", "--json").stdout)
    return {name: np.array(column, float) for name, column in table_of(tmp_path / "out" / "results.csv").items()}, summary


def test_consistency_same_bits_as_the_command_line(thrust, printed):
    table, summary = printed
    results = roulement.run(thrust)
    assert results.names == list(table) and len(table) > 250
    for name in results.names:
        assert np.array_equal(bits(results[name]), bits(table[name])), name
    for key in ("figures", "means", "steps", "energy_balance"):
        assert results.summary[key] == summary[key]
    assert results.units["ball[3].inner.contact_angle"] == "rad"
    assert np.array_equal(results["inner.force"][:, 1], table["inner.force.y"])
    assert np.array_equal(results["ball.outer.load"][:, 4], table["ball[5].outer.load"])
    power = results.mean("friction power")
    assert power in summary["means"]["quantities"] and power["unit"] == "W"
    with pytest.raises(KeyError, match="ball.inner.lod is no column of this run; near are ball.inner.load"):
        results["ball.inner.lod"]
    with pytest.raises(KeyError, match="near are friction power"):
        results.mean("Friction_power")


def test_scenes_by_the_path_of_their_file(thrust, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(thrust.source)
    results, by_path = roulement.run(thrust), roulement.run(str(path))
    assert np.array_equal(bits(results["inner.force"]), bits(by_path["inner.force"]))
    assert np.array_equal(roulement.equilibrium(path).load, roulement.equilibrium(thrust).load)
    assert roulement.effects(path) == roulement.effects(thrust)
    simulation = roulement.Simulation(path)
    with pytest.raises(KeyError, match="near are .*inner.force"):
        simulation["inner.forze"]
    with pytest.raises(OSError):
        roulement.run(tmp_path / "none.toml")


def test_what_a_notebook_shows(thrust):
    scene = thrust.with_(title="5 < 6")._repr_html_()
    assert "<b>5 &lt; 6</b>" in scene and "[bearing]" in scene
    shown = roulement.run(thrust)._repr_html_()
    assert "21 rows over 0 to 2 ms" in shown
    assert "<td>friction power</td>" in shown and "<td>W</td>" in shown


def test_columns_window_and_progress(thrust):
    seen = []
    few = roulement.run(thrust, columns=["inner.force.*", "ball[2].inner.load"], window=(1e-3, None), progress=lambda *at: seen.append(at))
    assert few.names == ["time", "inner.force.x", "inner.force.y", "inner.force.z", "ball[2].inner.load"]
    assert few.time[0] == pytest.approx(1e-3) and len(few.time) == 11
    assert seen[-1] == (2e-3, 2e-3)
    with pytest.raises(ValueError, match="inner.forc"):
        roulement.run(thrust, columns="inner.forc")

    def stop(time, duration):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        roulement.run(thrust, progress=stop)


def test_failed_runs_are_told(thrust):
    with pytest.raises(RuntimeError, match="step"):
        roulement.run(thrust.with_({"solver.min_step": "9 us", "solver.initial_step": "10 us", "solver.tolerance": 1e-12}))


def test_consistency_an_error_goal_is_measured_as_by_the_command_line(thrust, tmp_path):
    scene = thrust.with_({"solver.accuracy": {"error": 1e-2}})
    (tmp_path / "scene.toml").write_text(scene.source)
    printed = json.loads(program("run", tmp_path / "scene.toml", "-o", tmp_path / "out", "--json").stdout)
    summary = roulement.run(scene).summary
    assert summary["error_goal"] == "met" and summary["means"] == printed["means"]
    assert summary["error_bars"] == printed["error_bars"] and summary["error_bars"]["friction torque"] > 0


def test_consistency_parquet_is_the_file_of_the_command_line(thrust, tmp_path):
    results = roulement.run(thrust, columns="inner.*")
    results.to_parquet(tmp_path / "python.parquet")
    (tmp_path / "scene.toml").write_text(thrust.source)
    program("run", tmp_path / "scene.toml", "-o", tmp_path / "program.parquet", "--columns", "inner.*")
    assert (tmp_path / "python.parquet").read_bytes() == (tmp_path / "program.parquet").read_bytes()
    # Read by others, where they are installed.
    parquet = pytest.importorskip("pyarrow.parquet")
    read = parquet.read_table(tmp_path / "python.parquet")
    assert read.column_names == results.names
    assert all(np.array_equal(bits(read[name].to_numpy()), bits(results[name])) for name in results.names)
    assert json.loads(read.schema.metadata[b"units"]) == results.units


def test_frames_of_pandas(thrust):
    pytest.importorskip("pandas")
    results = roulement.run(thrust)
    frame = results.to_pandas()
    assert np.array_equal(frame["friction_power"].to_numpy(), results["friction_power"])
    assert np.array_equal(frame.index.to_numpy(), results.time) and frame.attrs["units"]["friction_power"] == "W"


def test_frames_of_polars(thrust):
    pytest.importorskip("polars")
    results = roulement.run(thrust)
    frame = results.to_polars()
    assert frame.columns == results.names and np.array_equal(frame["friction_power"].to_numpy(), results["friction_power"])


def test_data_sets_of_xarray(thrust):
    pytest.importorskip("xarray")
    results = roulement.run(thrust)
    data = results.to_xarray()
    assert data["ball.inner.load"].dims == ("time", "ball") and data["ball.inner.load"].attrs["units"] == "N"
    assert np.array_equal(data["ball.inner.load"].sel(ball=3), results["ball[3].inner.load"])
    assert np.array_equal(data["inner.force.x"], results["inner.force.x"])


def test_other_threads_go_on_during_a_run(thrust):
    """The interpreter is free: another thread goes on as if there were no run."""
    # Long enough for a hundred turns of the other thread on a fast machine, too.
    scene, counted = thrust.with_({"load.duration": "300 ms"}), [0]
    begin = time.monotonic()
    runner = threading.Thread(target=roulement.run, args=(scene,))
    runner.start()
    while runner.is_alive():
        time.sleep(1e-3)
        counted[0] += 1
    elapsed = time.monotonic() - begin
    assert counted[0] > 0.2 * elapsed / 1e-3 and counted[0] > 20, (counted, elapsed)


def test_contacts_on_arrays_are_those_of_the_command_line(tmp_path):
    creep = np.linspace(-4e-3, 4e-3, 7)
    spin = np.array([[0.0], [5.0]])
    names = ["poisson_ratio", "shear_modulus", "friction", "peak_pressure", "semi_axis_x", "semi_axis_y", "rolling_angle", "creep_x", "creep_y", "spin"]
    rows = [[0.3, 79.3e9, 0.08, 1.2e9, 1e-4, 6e-4, 0.0, x, 1e-3, s] for s in spin[:, 0] for x in creep]
    lines = [",".join(["id", *names])] + [f"{i}," + ",".join(map(repr, map(float, row))) for i, row in enumerate(rows)]
    (tmp_path / "cases.csv").write_text("\n".join(lines))
    for law in ("linear", "saturated", "kalker", "kalker_table", "regularised"):
        (tmp_path / "out.csv").write_text(program("contact", "--law", law, tmp_path / "cases.csv").stdout)
        printed = table_of(tmp_path / "out.csv")
        found = roulement.contact(law, peak_pressure=1.2e9, semi_axis_x=1e-4, semi_axis_y=6e-4, creep_x=creep, creep_y=1e-3, spin=spin)
        assert found["fx"].shape == (2, 7)
        for name in ("fx", "fy", "mz", "power"):
            assert np.array_equal(found[name].ravel(), np.array(printed[name], float)), (law, name)
    with pytest.raises(ValueError, match="semi_axis_x = -1"):
        roulement.contact("linear", peak_pressure=1e9, semi_axis_x=-1.0, semi_axis_y=1e-4)
    with pytest.raises(ValueError, match="kalker_table"):
        roulement.contact("coulomb", peak_pressure=1e9, semi_axis_x=1e-4, semi_axis_y=1e-4)
