"""Design of experiments and sensitivity: which of clearance, conformity, friction and so on a result depends on.

>>> ranges = {"friction.ball_race": (0.04, 0.12), "outer.misalignment.rz": ("0 mrad", "1 mrad")}
>>> cases = design.sobol(ranges, 64)                                   # for `sweep.run`; needs SciPy
>>> study = design.sensitivity(scene, ranges, ["friction_power.mean", "life.L10r.end"], "study")       # needs SALib
>>> study.plot("sensitivity.svg")                                      # needs matplotlib

Ranges are of numbers in SI or of texts with the same unit.
"""

from dataclasses import dataclass

import numpy as np

from . import sweep


def _limits(ranges):
    """Lower and upper ends, and units."""
    lower, upper, units = [], [], []
    for key, (begin, end) in ranges.items():
        (a, unit), (b, other) = _number(key, begin), _number(key, end)
        if unit != other:
            raise ValueError(f"{key}: both ends of a range need the same unit")
        if not a < b:
            raise ValueError(f"{key}: a range has to grow: {begin}, {end}")
        lower.append(a), upper.append(b), units.append(unit)
    return np.array(lower), np.array(upper), units


def _number(key, value):
    if isinstance(value, str):
        number, _, unit = value.strip().partition(" ")
        return float(number), unit.strip()
    return float(value), ""


def _cases(ranges, values):
    _, _, units = _limits(ranges)
    text = lambda value, unit: f"{float(value)!r} {unit}" if unit else float(value)
    return [{key: text(value, unit) for key, value, unit in zip(ranges, row, units)} for row in values]


def _scaled(ranges, shares):
    lower, upper, _ = _limits(ranges)
    return _cases(ranges, lower + shares * (upper - lower))


def sobol(ranges, count, seed=0):
    """Cases of a scrambled Sobol sequence over ranges, best a power of two of them. Needs SciPy."""
    from scipy.stats import qmc

    return _scaled(ranges, qmc.Sobol(len(ranges), rng=seed).random(count))


def latin_hypercube(ranges, count, seed=0):
    """Cases of a Latin hypercube over ranges. Needs SciPy."""
    from scipy.stats import qmc

    return _scaled(ranges, qmc.LatinHypercube(len(ranges), rng=seed).random(count))


@dataclass(frozen=True)
class Sensitivity:
    """Sensitivity of results to keys."""

    method: str
    """`morris`: mean of the absolute elementary effects; `sobol`: total share of the variance."""
    keys: list
    """Keys that were varied."""
    strength: dict
    """An array over the keys for each result: `mu_star` in the result's unit over the whole range, or the total index [-]."""
    error: dict
    """Its 95 % interval, half."""
    table: sweep.Table | None = None
    """All cases."""

    def plot(self, path):
        """Bars of every result over the keys, as shares of the strongest one. Needs matplotlib."""
        from matplotlib.figure import Figure

        figure = Figure(figsize=(7, 1.2 + 0.45 * len(self.keys) * max(1, len(self.strength)) / 2), layout="constrained")
        axes = figure.subplots()
        places, width = np.arange(len(self.keys)), 0.8 / len(self.strength)
        for k, (name, strength) in enumerate(self.strength.items()):
            scale = 1.0 / max(np.abs(strength).max(), np.finfo(float).tiny)
            axes.barh(places + k * width, strength * scale, width, xerr=self.error[name] * scale, label=name)
        axes.set_yticks(places + 0.4 - width / 2, self.keys)
        axes.set_xlabel("strength over that of the strongest key [-]")
        axes.set_title({"morris": "elementary effects (Morris)", "sobol": "total Sobol indices"}[self.method])
        axes.legend()
        figure.savefig(path)


def _problem(ranges):
    lower, upper, _ = _limits(ranges)
    return {"num_vars": len(ranges), "names": list(ranges), "bounds": np.column_stack([lower, upper]).tolist()}


def _sample(problem, method, count, seed):
    if method == "morris":
        from SALib.sample import morris

        return morris.sample(problem, count, seed=seed)
    if method == "sobol":
        from SALib.sample import sobol as saltelli

        return saltelli.sample(problem, count, calc_second_order=False, seed=seed)
    raise ValueError(f"method = {method!r} is none of \"morris\", \"sobol\"")


def _analysed(problem, method, samples, results, seed):
    """Strength of each key and its interval."""
    if method == "morris":
        from SALib.analyze import morris

        found = morris.analyze(problem, samples, results, seed=seed)
        return np.array(found["mu_star"], float), np.array(found["mu_star_conf"], float)
    from SALib.analyze import sobol as saltelli

    found = saltelli.analyze(problem, results, calc_second_order=False, seed=seed)
    return np.array(found["ST"], float), np.array(found["ST_conf"], float)


def sensitivity_of(function, ranges, method="morris", count=16, seed=0):
    """Sensitivity of functions: `function(cases)` gives a dictionary of arrays, a value for each case. Needs SALib.

    `count` trajectories with a case more than there are keys each (`morris`), or a power of two of points with two cases more
    (`sobol`).
    """
    problem = _problem(ranges)
    samples = _sample(problem, method, count, seed)
    results = function(_cases(ranges, samples))
    table = results.pop("table", None)
    found = {name: _analysed(problem, method, samples, np.asarray(values, float), seed) for name, values in results.items()}
    strength, error = ({name: of[place] for name, of in found.items()} for place in (0, 1))
    return Sensitivity(method, list(ranges), strength, error, table)


def sensitivity(scene, ranges, results, output, method="morris", count=16, seed=0, **options):
    """Sensitivity of columns of a sweep's summary, such as `friction_power.mean`, `life.L10r.end`, `ball.inner.load.largest`, to
    keys of the scene over ranges. The cases are run into a directory, resumable; `options` are those of `sweep.run`. Needs SALib.

    Raises RuntimeError if a case fails.
    """

    def function(cases):
        table = sweep.run(cases, scene, output, **options)
        if not all(table["status"] == "done"):
            worst = int(np.argmax(table["status"] != "done"))
            raise RuntimeError(f"case {worst + 1} of the study has no result: {table['reason'][worst]}")
        return {"table": table, **{name: table[name] for name in results}}

    return sensitivity_of(function, ranges, method, count, seed)
