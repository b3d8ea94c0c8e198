"""Sweeps on Dask, in processes of its own: workers come and go, they and the scheduler die, and the numbers are those of the command line."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time

# A scheduler that has gone is given up sooner than by default; read where Dask is imported.
os.environ.setdefault("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "3s")

import pytest
from conftest import ROOT, cases, program
from roulement import _cluster, sweep

distributed = pytest.importorskip("distributed")

THRUST = ROOT / "scenes" / "thrust.toml"


class Processes:
    """Schedulers and workers that are started and killed."""

    def __init__(self, folder):
        self.folder, self.running, self.environment = folder, [], {}
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"

    def start(self, *arguments):
        log = open(self.folder / f"dask-{len(self.running)}.log", "w")
        command = [sys.executable, "-m", "distributed.cli." + arguments[0], *map(str, arguments[1:])]
        process = subprocess.Popen(command, stdout=log, stderr=log, env={**os.environ, **self.environment})
        self.running.append(process)
        return process

    def scheduler(self):
        return self.start("dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")

    def worker(self, *options):
        common = ["--nthreads", "1", "--no-dashboard", "--death-timeout", "60", "--local-directory", self.folder]
        return self.start("dask_worker", self.address, *common, *(options or ["--no-nanny"]))

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


def wait_for(condition, seconds=120):
    """Waits until something holds."""
    begin = time.monotonic()
    while not condition():
        assert time.monotonic() - begin < seconds
        time.sleep(0.05)


def kept(folder):
    """Files of finished cases and when they were written."""
    files = (folder / "cases").glob("[!.]*.csv") if (folder / "cases").exists() else []
    return {file.name: file.stat().st_mtime_ns for file in files}


def begun(processes, folder, path, count, batch=2):
    """A sweep in a thread that has finished a few cases; it leaves its table in the list."""
    found = []
    run = lambda: found.append(sweep.run(path, THRUST, folder, scheduler=processes.address, batch=batch))
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
    own = sweep.run(path, THRUST, tmp_path / "own")
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


def test_a_cluster_may_start_empty_grow_and_lose_all_its_workers(processes, tmp_path):
    """Tasks in flight follow the workers: four where there is none, then `AHEAD` for each thread."""
    path, count = tmp_path / "cases.csv", 150
    path.write_text(cases(count, "40 ms"))
    processes.scheduler()
    thread, found = begun(processes, tmp_path / "grown", path, 0, batch=1)
    with distributed.Client(processes.address, timeout=30, set_as_default=False) as client:
        # Those that are done stay until the client has taken their rows.
        tasks = lambda: client.run_on_scheduler(lambda dask_scheduler: sum(task.state != "memory" for task in dask_scheduler.tasks.values()))
        wait_for(lambda: tasks() == _cluster.FIRST)
        time.sleep(2.5 * _cluster.LOOK)
        assert tasks() == _cluster.FIRST and not kept(tmp_path / "grown") and thread.is_alive()

        first = processes.worker()
        wait_for(lambda: len(kept(tmp_path / "grown")) >= 2)
        # All workers go, as those of a queue do whose time is over; then others come, and more.
        first.send_signal(signal.SIGKILL)
        first.wait()
        workers = [processes.worker() for _ in range(3)]
        wait_for(lambda: tasks() > 2 * _cluster.AHEAD)
        assert tasks() <= 3 * _cluster.AHEAD and len(client.nthreads()) == 3
        wait_for(lambda: len(kept(tmp_path / "grown")) >= 60)
        assert thread.is_alive(), "there is work for all"
        shares = client.run(lambda dask_worker: dask_worker.state.executed_count)
        assert len(shares) == 3 and min(shares.values()) >= 2, shares
        workers[0].send_signal(signal.SIGKILL)
        thread.join(180)
    table = whole(found, tmp_path / "grown", count, {})
    sweep.run(path, THRUST, tmp_path / "own")
    assert (tmp_path / "own" / "summary.csv").read_bytes() == (tmp_path / "grown" / "summary.csv").read_bytes()
    assert len(table) == count


def preload(folder, text):
    """A file that workers run as they start."""
    path = folder / "preload.py"
    path.write_text(text)
    return "--preload", path


def test_a_worker_of_another_version_or_without_the_package_is_told(processes, tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text(cases(4, "1 ms"))
    processes.scheduler()
    other = preload(tmp_path, "from roulement import _native\n_native.version = lambda: '0.0.1 (other)'\n")
    worker = processes.worker("--no-nanny", *other)
    with pytest.raises(RuntimeError) as told:
        sweep.run(path, THRUST, tmp_path / "out", scheduler=processes.address)
    assert "0.0.1 (other)" in str(told.value) and _cluster.VERSION in str(told.value) and "same version" in str(told.value)
    worker.kill()
    worker.wait()
    processes.worker("--no-nanny", *preload(tmp_path, "import sys\nsys.modules['roulement'] = None\n"))
    with pytest.raises(RuntimeError, match="a worker has no roulement .*same version"):
        sweep.run(path, THRUST, tmp_path / "out", scheduler=processes.address)
    assert not kept(tmp_path / "out")


def test_a_case_that_ends_its_workers_is_named_and_others_are_kept(processes, tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text(cases(6, "1 ms").replace("0.04,", "0.1234,", 1))
    processes.environment["DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES"] = "0"
    processes.scheduler()
    # Run twice in a worker that has a nanny.
    dying = "import os, time\nfrom roulement import _native\n_native.own = getattr(_native, 'own', _native.case_row)\n"
    dying += "die = lambda: (time.sleep(2), os._exit(1))\n"
    dying += "_native.case_row = lambda text, **wanted: die() if '0.1234' in text else _native.own(text, **wanted)\n"
    processes.worker("--nanny", *preload(tmp_path, dying))
    with pytest.raises(RuntimeError, match="ended by case 1 "):
        sweep.run(path, THRUST, tmp_path / "out", scheduler=processes.address, batch=3)
    table = sweep.Table(tmp_path / "out" / "summary.csv")
    assert list(table["status"]) == ["not run"] + ["done"] * 5 and len(kept(tmp_path / "out")) == 5


def test_closed_form_tasks_take_the_time_that_they_should():
    sizes = _cluster.Sizes()
    assert sizes.next(10**6, 10) == 1, "nothing is known yet"
    sizes.learn(1, 0.5)
    assert sizes.next(10**6, 10) == int(_cluster.AIM / 0.5)
    # In the end all threads have some; tasks of tiny cases have no more than the scheduler likes.
    assert sizes.next(40, 10) == 2 and sizes.next(3, 10) == 1
    sizes.learn(1000, 1e-3)
    for _ in range(40):
        sizes.learn(1000, 1e-3)
    assert sizes.next(10**6, 10) == _cluster.MOST
    # Cases that take longer than a task should have one each.
    for _ in range(40):
        sizes.learn(1, 100.0)
    assert sizes.next(10**6, 10) == 1
    assert _cluster.Sizes(7).next(10**6, 10) == 7


def test_tasks_grow_to_the_time_that_they_should_take_and_end_before_the_longest(tmp_path, monkeypatch):
    """With a hundredth of the times, and cases of some milliseconds."""
    path, count = tmp_path / "cases.csv", 400
    path.write_text(cases(count, "4 ms"))
    monkeypatch.setattr(_cluster, "AIM", 0.2)
    seen, own = [], _cluster.Sizes.learn
    monkeypatch.setattr(_cluster.Sizes, "learn", lambda self, cases, seconds: (seen.append((cases, seconds)), own(self, cases, seconds)))
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
        with distributed.Client(cluster, set_as_default=False) as client:
            table = sweep.run(path, THRUST, tmp_path / "grown", scheduler=client)
            sizes = [cases for cases, _ in seen]
            assert sizes[0] == 1 and sum(sizes) == count == len(table)
            assert max(sizes) > 4 and max(seconds for _, seconds in seen) < 2.5 * _cluster.AIM, seen
            # Fixed ones would be longer than the longest: what they have not begun is given to others.
            seen.clear()
            monkeypatch.setattr(_cluster, "LONGEST", 0.1)
            table = sweep.run(path, THRUST, tmp_path / "cut", scheduler=client, batch=count)
            assert len(seen) > 2 and sum(cases for cases, _ in seen) == count, seen
            assert all(seconds < 0.1 + 0.4 for _, seconds in seen), seen
    assert (tmp_path / "grown" / "summary.csv").read_bytes() == (tmp_path / "cut" / "summary.csv").read_bytes()


def test_the_module_runs_on_a_cluster_of_its_own(tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text(cases(6, "1 ms"))
    command = [sys.executable, "-m", "roulement.sweep", path, "--scene", THRUST, "-o", tmp_path / "out", "--workers", "2"]
    ended = subprocess.run(list(map(str, command)), capture_output=True, text=True, env={**os.environ, "DASK_LOGGING__DISTRIBUTED": "error"})
    assert ended.returncode == 0, ended.stderr
    assert "6 done, 0 failed, 0 not run" in ended.stdout
    program("sweep", path, "--scene", THRUST, "-o", tmp_path / "program")
    assert (tmp_path / "out" / "summary.csv").read_bytes() == (tmp_path / "program" / "summary.csv").read_bytes()
    ended = subprocess.run([*map(str, command[:4]), "--scene", "nowhere.toml"], capture_output=True, text=True)
    assert ended.returncode == 1 and "nowhere.toml" in ended.stderr and "Traceback" not in ended.stderr


# As SLURM answers: a job is a process that begins a moment later. Its number is that of its folder.
SBATCH = """#!/usr/bin/env bash
cp "$1" "$JOBS/job-$$.sh"
(sleep 1; exec bash "$JOBS/job-$$.sh") >"$JOBS/job-$$.log" 2>&1 &
echo $! >>"$JOBS/pids"
echo "Submitted batch job $$"
"""


def test_the_example_of_slurm_runs_on_jobs_that_a_queue_starts(tmp_path):
    """dask-jobqueue with a stand-in for `sbatch`: the cluster starts empty, and asks for workers as there are cases."""
    pytest.importorskip("dask_jobqueue")
    path = tmp_path / "cases.csv"
    path.write_text(cases(12, "1 ms"))
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, text in (("sbatch", SBATCH), ("scancel", "#!/bin/sh\nexit 0\n")):
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    example = ROOT / "examples" / "sweeps" / "slurm_dask.py"
    start = "import runpy, sys; example = runpy.run_path(sys.argv[1]); example['JOB'].update(cores=1, processes=1, memory='1 GB'); "
    start += "example['main'](*sys.argv[2:], jobs=2)"
    command = [sys.executable, "-c", start, example, path, THRUST, tmp_path / "out"]
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "JOBS": str(tmp_path)}
    try:
        ended = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment, cwd=tmp_path, timeout=240)
    finally:
        for process in (tmp_path / "pids").read_text().split() if (tmp_path / "pids").exists() else []:
            subprocess.run(["kill", process], stderr=subprocess.DEVNULL)
    assert ended.returncode == 0, ended.stderr
    assert "Table(12 cases" in ended.stdout
    jobs = list(tmp_path.glob("job-*.sh"))
    assert 1 <= len(jobs) <= 4, jobs
    for job in jobs:
        text = job.read_text()
        assert "#SBATCH -p batch" in text and "#SBATCH -t 02:00:00" in text and "--lifetime 110m" in text, text
        assert subprocess.run(["bash", "-n", job]).returncode == 0
    program("sweep", path, "--scene", THRUST, "-o", tmp_path / "program")
    assert (tmp_path / "out" / "summary.csv").read_bytes() == (tmp_path / "program" / "summary.csv").read_bytes()
