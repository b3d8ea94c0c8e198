"""Sweeps from Python: the same files as the command line's, on threads and on Dask with workers and schedulers that die."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time

# A scheduler that has gone is given up sooner than by default; read where Dask is imported.
os.environ.setdefault("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "3s")

import numpy as np
import pytest
import roulement
from conftest import ROOT, instance_of, program
from roulement import sweep

FRICTION = [0.05, 0.08, 0.11]


def cases(count, duration):
    """A table of cases that differ in friction."""
    rows = [f"{0.04 + 0.08 * k / count!r},{duration}" for k in range(count)]
    return "friction.ball_race,load.duration\n" + "\n".join(rows) + "\n"


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


# --- Dask, in processes of its own -------------------------------------------------------------------------------------------

distributed = pytest.importorskip("distributed")


class Processes:
    """Schedulers and workers that are started and killed."""

    def __init__(self, folder):
        self.folder, self.running = folder, []
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"

    def start(self, *arguments):
        log = open(self.folder / f"dask-{len(self.running)}.log", "w")
        process = subprocess.Popen([sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]], stdout=log, stderr=log)
        self.running.append(process)
        return process

    def scheduler(self):
        return self.start("dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")

    def worker(self):
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "60", "--local-directory", str(self.folder)]
        return self.start("dask_worker", self.address, *options)

    def end(self):
        for process in self.running:
            if process.poll() is None:
                process.kill()
            process.wait()


@pytest.fixture
def processes(tmp_path):
    processes = Processes(tmp_path)
    yield processes
    processes.end()


def kept(folder):
    """Files of finished cases and when they were written."""
    files = (folder / "cases").glob("[!.]*.csv") if (folder / "cases").exists() else []
    return {file.name: file.stat().st_mtime_ns for file in files}


def begun(processes, folder, path, count):
    """A sweep in a thread that has finished a few cases; it leaves its table in the list."""
    found = []
    run = lambda: found.append(sweep.run(path, ROOT / "scenes" / "thrust.toml", folder, scheduler=processes.address, batch=2))
    thread = threading.Thread(target=run)
    thread.start()
    begin = time.monotonic()
    while len(kept(folder)) < count:
        assert time.monotonic() - begin < 120 and thread.is_alive()
        time.sleep(5e-3)
    return thread, found


def whole(found, folder, count, before):
    """All cases are there, each once, and what was there was not written again."""
    (table,) = found
    assert len(table) == count and set(table["status"]) == {"done"}
    assert len(set(table["file"])) == count and len(kept(folder)) == count
    after = kept(folder)
    assert all(after[name] == at for name, at in before.items())
    return table


def test_a_killed_worker_and_a_restarted_scheduler_lose_no_case(processes, tmp_path):
    path, count = tmp_path / "cases.csv", 40
    path.write_text(cases(count, "40 ms"))
    processes.scheduler()
    workers = [processes.worker(), processes.worker()]
    thread, found = begun(processes, tmp_path / "killed", path, 4)
    workers[0].send_signal(signal.SIGKILL)
    before = kept(tmp_path / "killed")
    assert len(before) < count
    thread.join(180)
    table = whole(found, tmp_path / "killed", count, before)
    # The numbers are those of threads.
    own = sweep.run(path, ROOT / "scenes" / "thrust.toml", tmp_path / "own")
    assert (tmp_path / "own" / "summary.csv").read_bytes() == (tmp_path / "killed" / "summary.csv").read_bytes()
    assert len(own) == len(table)

    # Scheduler and workers die, and come back.
    thread, found = begun(processes, tmp_path / "restarted", path, 4)
    for process in processes.running:
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
            process.wait()
    before = kept(tmp_path / "restarted")
    assert 4 <= len(before) < count
    processes.scheduler()
    processes.worker()
    thread.join(240)
    whole(found, tmp_path / "restarted", count, before)
    assert (tmp_path / "own" / "summary.csv").read_bytes() == (tmp_path / "restarted" / "summary.csv").read_bytes()


def test_the_module_runs_on_a_cluster_of_its_own(tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text(cases(6, "1 ms"))
    command = [sys.executable, "-m", "roulement.sweep", path, "--scene", ROOT / "scenes" / "thrust.toml", "-o", tmp_path / "out", "--workers", "2"]
    ended = subprocess.run(list(map(str, command)), capture_output=True, text=True, env={**os.environ, "DASK_LOGGING__DISTRIBUTED": "error"})
    assert ended.returncode == 0, ended.stderr
    assert "6 done, 0 failed, 0 not run" in ended.stdout
    program("sweep", path, "--scene", ROOT / "scenes" / "thrust.toml", "-o", tmp_path / "program")
    assert (tmp_path / "out" / "summary.csv").read_bytes() == (tmp_path / "program" / "summary.csv").read_bytes()
    ended = subprocess.run([*map(str, command[:4]), "--scene", "nowhere.toml"], capture_output=True, text=True)
    assert ended.returncode == 1 and "nowhere.toml" in ended.stderr and "Traceback" not in ended.stderr
