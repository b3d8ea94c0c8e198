"""Sweeps: many cases of a scene on all cores, or on many machines by Dask.

>>> from roulement import sweep
>>> table = sweep.run({"friction.ball_race": [0.05, 0.1], "load.x.force": ["1 kN", "2 kN"]}, scene, "results")
>>> table["friction_power.mean"]       # [W], a value for each of the four cases

`python -m roulement.sweep CASES -o DIR --scheduler ADDRESS` is the same from a shell, on a cluster. What is done is in the directory and
is not run again (docs/sweeps.md).
"""

import argparse
import csv
import math
import os
import sys
import time
from pathlib import Path

import numpy as np

from . import _native
from ._toml import flat, to_toml

PATIENCE = 600.0
"""How long a scheduler that has gone is waited for [s]."""


class Table:
    """The summary of a sweep: an array for each column, a value for each case; `units` of its columns."""

    def __init__(self, path):
        with open(path, newline="") as file:
            header, *rows = csv.reader(file)
        self._columns, self.units = {}, {}
        for name, cells in zip(header, zip(*rows)):
            name, _, unit = name.partition(" [")
            self._columns[name] = _array(cells)
            self.units[name] = unit.removesuffix("]")

    @property
    def names(self):
        """Names of all columns."""
        return list(self._columns)

    def __getitem__(self, name):
        return self._columns[name]

    def __len__(self):
        return len(self._columns["case"])

    def __repr__(self):
        return f"Table({len(self)} cases, {len(self._columns)} columns)"

    def to_pandas(self):
        """A pandas DataFrame; units in `attrs["units"]`. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(self._columns)
        frame.attrs["units"] = self.units
        return frame


def _array(cells):
    try:
        return np.array([float(cell) if cell else math.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def _open(cases, scene, output, wanted):
    """The cases and their directory."""
    if isinstance(scene, (str, os.PathLike)):
        text = _native.base_scene(Path(scene))
    else:
        text = scene.source if scene else None
    options = {"scene": text, **wanted}
    if isinstance(cases, (str, os.PathLike)):
        return _native.Sweep(Path(output), path=Path(cases), **options)
    if isinstance(cases, dict):
        axes = {key: axis if isinstance(axis, dict) and "from" in axis else list(axis) for key, axis in cases.items()}
        lines = ["[grid]"] + [f"{_quoted(key)} = {to_toml(axis)}" for key, axis in axes.items()]
    else:
        lines = []
        for case in cases:
            lines += ["[[case]]"] + [f"{_quoted(key)} = {to_toml(value)}" for key, value in flat(case)]
    return _native.Sweep(Path(output), text="\n".join(lines), **options)


def _quoted(key):
    return ".".join(to_toml(part) for part in key.split("."))


class _Progress:
    """One line with an estimate of what is left."""

    def __init__(self, shown):
        self.shown, self.begin, self.told = shown, time.monotonic(), None

    def __call__(self, done, count, threads=None):
        """Of a cluster `threads` are those of its workers."""
        if not self.shown or count == 0 or (done, threads) == self.told:
            return
        self.told = done, threads
        elapsed = time.monotonic() - self.begin
        left = f"{elapsed / done * (count - done):.0f} s left" if done else ""
        if threads is not None:
            left += f", {threads} threads of workers" if threads else ", no worker yet"
        end = "\n" if done >= count else ""
        print(f"\r{done} of {count} cases, {elapsed:.0f} s elapsed, {left}   ", end=end, file=sys.stderr, flush=True)


def run(
    cases, scene=None, output="sweep", columns=(), workers=None, scheduler=None, batch=None, progress=False, growth=False
):
    """Runs all cases that are not done yet and returns the summary, a `Table`.

    `cases` is the path of a table (CSV or TOML), a list of dictionaries with keys of the scene, or a dictionary of lists: all
    combinations. `scene` is the base scene, `output` the directory. `columns` are variables whose mean, least, largest and last
    value are wanted, too. `workers` are threads. With `scheduler`, the address of one of Dask or a `distributed.Client`, cases
    run there in batches of `batch`, or, if that is not given, of about ten seconds; workers may come and go meanwhile. With `growth`
    the summary also has what grows or decays where each case starts, as that of `roulement sweep --growth`: `grows` ("yes", "no",
    "cannot tell"), `growth` [1/s], `growth.frequency` [Hz], `growth.motion`, and `circles` of every bearing.

    Raises ValueError for a key that no case can be read with, RuntimeError if workers have another version of this package or a scheduler
    stays away; a case that fails is a row with its reason.
    """
    wanted = {"columns": [columns] if isinstance(columns, str) else list(columns), "growth": growth}
    sweep = _open(cases, scene, output, wanted)
    told = _Progress(progress)
    try:
        if scheduler is None:
            sweep.run(sweep.missing(), workers, told)
        else:
            _run_on(scheduler, sweep, wanted, batch, told)
    finally:
        # Also of a sweep that was interrupted.
        sweep.write_summary()
    return Table(Path(output) / "summary.csv")


def _run_on(scheduler, sweep, wanted, batch, told):
    """Runs what is missing on a scheduler; goes on where it was when that comes back."""
    from distributed import Client

    from . import _cluster

    first = sweep.missing()
    begin = time.monotonic()
    while missing := sweep.missing():
        before = len(first) - len(missing)
        heard = lambda done, threads, before=before: told(before + done, len(first), threads)
        try:
            if isinstance(scheduler, Client):
                return _cluster.run(scheduler, sweep, missing, wanted, batch, heard)
            with Client(scheduler, timeout=10, set_as_default=False) as client:
                _cluster.run(client, sweep, missing, wanted, batch, heard)
        except (OSError, _cluster.Lost) as why:
            if isinstance(scheduler, Client):
                raise RuntimeError(f"the scheduler has gone: {why}; the same call with a new client goes on") from why
            if len(sweep.missing()) < len(missing):
                begin = time.monotonic()
            if time.monotonic() - begin > PATIENCE:
                raise RuntimeError(f"the scheduler {scheduler} has gone: {why}; the same call goes on") from why
            time.sleep(0.5)


def main(arguments=None):
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m roulement.sweep", description="Runs many cases of a scene on a Dask cluster.")
    parser.add_argument("cases", help="table of cases, CSV or TOML (docs/sweeps.md)")
    parser.add_argument("--scene", help="base scene; that of the table if not given")
    parser.add_argument("-o", "--output", default="sweep", help="directory for the results; what is done there is not run again")
    parser.add_argument("--columns", default="", help="variables whose mean, least, largest and last value are wanted, too")
    parser.add_argument("--growth", action="store_true", help="look at what grows about the start of each case, and at races that circle")
    parser.add_argument("--scheduler", help="address of a Dask scheduler, such as tcp://host:8786; a cluster of this machine if not given")
    parser.add_argument("--workers", type=int, help="processes of that cluster; as many as there are cores if not given")
    parser.add_argument("--batch", type=int, help="cases of a task; as many as take about ten seconds if not given")
    given = parser.parse_args(arguments)
    options = {
        "scene": given.scene,
        "output": given.output,
        "columns": [name for name in given.columns.split(",") if name],
        "batch": given.batch,
        "progress": sys.stderr.isatty(),
        "growth": given.growth,
    }
    try:
        if given.scheduler:
            table = run(given.cases, scheduler=given.scheduler, **options)
        else:
            from distributed import Client, LocalCluster

            workers = given.workers or os.cpu_count()
            with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
                table = run(given.cases, scheduler=client, **options)
    except KeyboardInterrupt:
        print("interrupted; the same command goes on", file=sys.stderr)
        return 130
    except (ValueError, OSError, RuntimeError) as why:
        print(f"error: {why}", file=sys.stderr)
        return 1
    count = {status: int(np.sum(table["status"] == status)) for status in ("done", "failed", "not run")}
    print(", ".join(f"{number} {status}" for status, number in count.items()))
    print(f"summary          {Path(given.output) / 'summary.csv'}")
    return 0 if count["done"] == len(table) else 4


if __name__ == "__main__":
    # The module by its name: workers import it so.
    from roulement.sweep import main as named

    sys.exit(named())
