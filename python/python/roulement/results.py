"""Runs and their results."""

import json
import math
import re
import sys
from html import escape

import numpy as np

from . import _native
from ._names import unknown
from .scene import Scene

_BALL = re.compile(r"ball\[(\d+)\]\.(.*)")


class Results:
    """Histories of a run: arrays by name, with their units.

    `results["friction_power"]` is a history; `results["inner.force"]` has its components x, y, z as columns, and
    `results["ball.inner.load"]` one for each ball. Those of a bearing on a shaft have its name before them:
    `results.bearing("left")["ball.inner.load"]`, or `results["left.friction_power"]`. `results.time` [s] are the times of all rows,
    `results.summary` is what `roulement run --json` prints.
    """

    def __init__(self, names, table, summary):
        self._places = {name: place for place, (name, _) in enumerate(names)}
        self._table = table
        self.units = dict(names)
        """Unit of every column."""
        self.summary = summary
        """Figures, means with their intervals and whether they have settled, steps: a dictionary."""

    @property
    def names(self):
        """Names of all columns, the time first."""
        return list(self._places)

    @property
    def time(self):
        """[s]"""
        return self._table[:, 0]

    def parts(self, name):
        """Names of the columns of a quantity: itself, its components, or those of all balls."""
        if name in self._places:
            return [name]
        if name.startswith("ball."):
            of_balls = [f"ball[{ball}].{name[5:]}" for ball in range(1, 1 + self.balls)]
            found = [of for of in of_balls if of in self._places]
        else:
            found = [of for of in (f"{name}.{axis}" for axis in "wxyz") if of in self._places]
        if not found:
            raise unknown(name, "column of this run", dict.fromkeys([*map(_quantity, self._places), *self._places]))
        return found

    @property
    def balls(self):
        """Number of balls that have columns."""
        return max((int(found[1]) for found in map(_BALL.match, self._places) if found), default=0)

    def __getitem__(self, name):
        places = [self._places[of] for of in self.parts(name)]
        return self._table[:, places[0]] if name in self._places else self._table[:, places]

    def bearing(self, name):
        """The results of a bearing of a shaft by itself, as those of a bearing alone are."""
        before = f"{name}."
        own = [column for column in self.names if column.startswith(before)]
        if name not in self.summary or not own:
            bearings = [of for of in self.summary if any(column.startswith(f"{of}.") for column in self.names)]
            raise unknown(name, "bearing of this run with columns in it", bearings)
        names = [("time", self.units["time"])] + [(column[len(before):], self.units[column]) for column in own]
        return Results(names, self._table[:, [0, *(self._places[column] for column in own)]], self.summary[name])

    def mean(self, quantity):
        """Mean of a quantity over the second half of the run with its interval at 95 %, drift and whether it has settled, as a
        dictionary. Names are those of means.csv, such as `friction power`; those of a shaft are those of its variables."""
        if "means" not in self.summary:
            return Results([("time", "s")], self._table[:, :1], self.summary["shaft"]).mean(quantity)
        for mean in self.summary["means"]["quantities"]:
            if mean["quantity"] == quantity:
                return mean
        raise unknown(quantity, "quantity with a mean", [mean["quantity"] for mean in self.summary["means"]["quantities"]])

    def phase(self, name):
        """A phase of the run, `[[phase]]` of its scene, as a dictionary: its window [s], whether it has settled, heat of friction [J],
        life and damage, `quantities` with mean, least and largest value, and `peaks`. That of a bearing on a shaft is
        `results.bearing("left").phase("aligned")`."""
        summary = self.summary if "phases" in self.summary else self.summary["shaft"]
        for phase in summary["phases"]:
            if phase["name"] == name:
                return phase
        raise unknown(name, "phase of this run", [phase["name"] for phase in summary["phases"]])

    def __repr__(self):
        rows, columns = self._table.shape
        return f"Results({rows} rows, {columns} columns)"

    def _repr_html_(self):
        """Means of the second half of the run, of a shaft those of each part."""
        parts = {"": self.summary} | {name: part for name, part in self.summary.items() if isinstance(part, dict) and "means" in part}
        rows = [
            f"<tr><td>{escape(name)}</td><td>{escape(mean['quantity'])}</td><td>{_short(mean['mean'])}</td>"
            f"<td>{_short(mean['interval_95'])}</td><td>{escape(mean['unit'])}</td></tr>"
            for name, part in parts.items()
            for mean in part.get("means", {}).get("quantities", [])
        ]
        head = "".join(f"<th>{of}</th>" for of in ("", "quantity", "mean", "+-", "unit"))
        of, columns = self._table.shape
        span = f"{1e3 * self.time[0]:.6g} to {1e3 * self.time[-1]:.6g} ms" if of else "no time"
        return f"<p>{of} rows over {span}, {columns} columns</p><table><tr>{head}</tr>{''.join(rows)}</table>"

    def to_pandas(self):
        """A pandas DataFrame over the time; units in `attrs["units"]`. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(self._table[:, 1:], columns=self.names[1:], index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = self.units
        return frame

    def to_polars(self):
        """A polars DataFrame; units are in `units`. Needs polars."""
        import polars

        return polars.DataFrame({name: self._table[:, place] for name, place in self._places.items()})

    def to_xarray(self):
        """An xarray Dataset over `time`, with the dimension `ball` for quantities of balls; units in `attrs["units"]`. Needs
        xarray."""
        import xarray

        of_balls, variables = {}, {}
        for name in self.names[1:]:
            found = _BALL.match(name)
            if found:
                of_balls.setdefault(f"ball.{found[2]}", name)
            else:
                variables[name] = (["time"], self[name], {"units": self.units[name]})
        for name, column in of_balls.items():
            values = self[name]
            if values.shape[1] == self.balls:
                variables[name] = (["time", "ball"], values, {"units": self.units[column]})
        return xarray.Dataset(variables, {"time": ("time", self.time, {"units": "s"}), "ball": np.arange(1, 1 + self.balls)})

    def to_parquet(self, path):
        """Writes what `roulement run -o x.parquet` writes, units in the file's metadata."""
        _native.write_parquet(str(path), list(self.units.items()), np.ascontiguousarray(self._table))


def _quantity(column):
    """Name by which the columns of all balls, or of all components, are read."""
    return re.sub(r"ball\[\d+\]", "ball", re.sub(r"\.[wxyz]$", "", column))


def _short(value):
    """A number as it is shown; nothing where there is none."""
    return "" if value is None or not math.isfinite(value) else f"{value:.4g}"


def _bar(time, duration):
    """One line of progress."""
    done = time / duration
    print(f"\rsimulated {time * 1e3:.3f} of {duration * 1e3:.3f} ms, {done:.0%}", end="", file=sys.stderr, flush=True)
    if time >= duration:
        print(file=sys.stderr)


def run(scene, columns=(), window=(None, None), progress=None):
    """Simulates a scene, or that of a file by its path, and returns its `Results`, with the same bits as `roulement run`.

    `columns` are names with `*` for any characters, all if none is given; `window` the times [s] between which rows are kept.
    `progress` is True for a line on standard error, or a function of time reached and duration [s]. With
    `solver.accuracy = { error = ... }` in the scene it is run until its error is that small. Ctrl-C ends it.

    Raises ValueError if a column is not there, RuntimeError if the bearing cannot be simulated.
    """
    begin, end = window
    limits = (-math.inf if begin is None else float(begin), math.inf if end is None else float(end))
    columns = [columns] if isinstance(columns, str) else list(columns)
    names, table, summary = _native.run(Scene.of(scene)._native, columns, limits, _bar if progress is True else progress or None)
    array = np.frombuffer(table, dtype=float).reshape(-1, len(names))
    return Results(names, array, json.loads(summary))
