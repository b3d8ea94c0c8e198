"""Trains the net of oblique rolling. `scripts/oblique-net` runs it.

Usage: oblique_net.py FEATURES WEIGHTS
FEATURES is what the example `oblique_contacts see` prints; WEIGHTS gets the net as `src/kalker/oblique_net.rs` reads it.

Squares of the errors of force (over mu N), moment (over mu N c) and power (relative, with a tenth of the creepage added to the power) are
made least by the method of Levenberg and Marquardt: first on a third of the contacts from several starts, then on all from the best of these.
At last large errors count more, as the fourth power of the error. A tenth of the contacts says how good a net is; no net learns from it.
"""
import sys
from pathlib import Path

import numpy

ODD, EVEN, UNITS, RESULTS = 8, 6, 24, 3
SHAPES = [(ODD + EVEN, UNITS), (UNITS,), (UNITS, UNITS), (UNITS,), (RESULTS, UNITS)]
SEED, STARTS = 1, 4
# Iterations on a third of the contacts, on all, and with large errors counting more.
FEW, ALL, TAIL = 50, 60, 30
# [-] weight of the relative error of power against that of a force.
POWER = 0.1
# [-] error from where its fourth power counts.
LARGE = 0.01
# Keeps weights small.
PENALTY = 1e-6
# Contacts at a time: what fits into the memory of a small machine.
CHUNK = 1000


class Contacts:
    """What the net sees of contacts, and what it should answer."""

    def __init__(self, rows):
        ends = numpy.cumsum([ODD, EVEN, 1, RESULTS, 1, RESULTS, 1])
        odd, even, factor, lacking, moment, creepage, power = numpy.split(rows, ends[:-1], axis=1)
        size = numpy.linalg.norm(creepage, axis=1, keepdims=True)
        by_force = numpy.zeros((len(rows), RESULTS + 1, RESULTS))
        by_force[:, 0, 0] = by_force[:, 1, 1] = 1.0
        by_force[:, 2, 2] = moment[:, 0]
        by_force[:, 3] = POWER * creepage / (power + 0.1 * size)
        self.odd, self.even, self.factor, self.lacking, self.by_force = odd, even, factor, lacking, by_force

    def __len__(self):
        return len(self.odd)

    def pick(self, which):
        """Some of them."""
        some = object.__new__(Contacts)
        for name, numbers in vars(self).items():
            setattr(some, name, numbers[which])
        return some

    def errors(self, weights):
        """Errors of both forces, moment and power, in units of the loss."""
        lack = self.factor * Layers(weights, self.odd, self.even).results() - self.lacking
        return numpy.einsum("nem,nm->ne", self.by_force, lack)


def split(weights):
    """Weights as matrices."""
    sizes = [int(numpy.prod(shape)) for shape in SHAPES]
    return [part.reshape(shape) for part, shape in zip(numpy.split(weights, numpy.cumsum(sizes)[:-1]), SHAPES)]


class Layers:
    """Units of both layers for the arguments as they are, and with the odd ones of the other sign."""

    def __init__(self, weights, odd, even):
        first, first_constant, second, second_constant, self.last = split(weights)
        self.second = second
        self.arguments = [numpy.concatenate([sign * odd, even], axis=1) for sign in (1, -1)]
        sums = [arguments @ first + first_constant for arguments in self.arguments]
        self.units, self.slopes = zip(*(self.bent(z) for z in sums))
        sums = [units @ second + second_constant for units in self.units]
        self.upper, self.upper_slopes = zip(*(self.bent(z) for z in sums))

    @staticmethod
    def bent(z):
        """Values and slopes of units."""
        inverse = 1 / numpy.sqrt(1 + z * z)
        return z * inverse, inverse**3

    def results(self):
        """The half of what both signs give."""
        return 0.5 * (self.upper[0] - self.upper[1]) @ self.last.T

    def gradient(self, result):
        """Derivatives of one result by all weights, a row for each contact."""
        count = len(self.upper[0])
        upper = [sign * self.last[result] * slopes for sign, slopes in zip((0.5, -0.5), self.upper_slopes)]
        lower = [(by_unit @ self.second.T) * slopes for by_unit, slopes in zip(upper, self.slopes)]
        products = [
            sum(values[:, :, None] * by_unit[:, None, :] for values, by_unit in zip(many, by)).reshape(count, -1)
            for many, by in ((self.arguments, lower), (self.units, upper))
        ]
        last = numpy.zeros((count, RESULTS, UNITS), self.last.dtype)
        last[:, result] = 0.5 * (self.upper[0] - self.upper[1])
        return numpy.concatenate([products[0], sum(lower), products[1], sum(upper), last.reshape(count, -1)], axis=1)


def equations(weights, contacts, large):
    """Normal equations of the least squares, and what is made least."""
    matrix, right, loss = numpy.zeros((len(weights), len(weights))), numpy.zeros(len(weights)), 0.0
    for begin in range(0, len(contacts), CHUNK):
        some = contacts.pick(slice(begin, begin + CHUNK))
        errors = some.errors(weights)
        square = (errors / large) ** 2
        loss += (errors**2 * (1 + square)).sum()
        single = numpy.float32
        layers = Layers(weights.astype(single), some.odd.astype(single), some.even.astype(single))
        by_force = numpy.stack([layers.gradient(result) for result in range(RESULTS)], axis=1)
        # Of e^2 + e^4/large^2 the slope is that of (1 + 2 e^2/large^2) e^2, with these as constants.
        scale = numpy.sqrt(1 + 2 * square)
        factors = (scale[:, :, None] * some.by_force * some.factor[:, :, None]).astype(single)
        rows = numpy.matmul(factors, by_force).reshape(-1, len(weights))
        matrix += rows.T @ rows
        right += rows.T @ (scale * errors).ravel().astype(single)
    return matrix, right + PENALTY * weights, loss + PENALTY * (weights**2).sum()


def loss_of(weights, contacts, large):
    """What is made least."""
    errors = contacts.errors(weights)
    return (errors**2 * (1 + (errors / large) ** 2)).sum() + PENALTY * (weights**2).sum()


def least(weights, contacts, iterations, large=numpy.inf):
    """Weights of a least sum."""
    damping = 1e-2
    for _ in range(iterations):
        matrix, right, loss = equations(weights, contacts, large)
        diagonal = numpy.diag(matrix)
        floor = 1e-3 * diagonal.mean()
        while damping < 1e6:
            damped = matrix + numpy.diag(PENALTY + damping * (diagonal + floor))
            moved = weights - numpy.linalg.solve(damped, right)
            after = loss_of(moved, contacts, large)
            if after < loss:
                break
            damping *= 4
        else:
            return weights
        weights, damping = moved, max(damping / 3, 1e-8)
        if loss - after < 1e-5 * loss:
            break
    return weights


def start(seed):
    """Random weights."""
    random = numpy.random.default_rng(seed)
    sizes = [1.5, 0.7, 1.5, 0.7, 0.3]
    fans = [ODD + EVEN, 1, UNITS, 1, UNITS]
    parts = [size * random.normal(size=shape) / fan**0.5 for size, shape, fan in zip(sizes, SHAPES, fans)]
    return numpy.concatenate([part.ravel() for part in parts])


def report(name, weights, contacts):
    """Prints errors; the mean of their squares, large ones counting more."""
    errors = contacts.errors(weights)
    force, moment = numpy.hypot(errors[:, 0], errors[:, 1]), abs(errors[:, 2])
    print(
        f"{name}: {len(contacts)} contacts, force over mu N mean {force.mean():.4f}, 99 % {numpy.quantile(force, 0.99):.3f}, "
        f"largest {force.max():.3f}; moment over mu N c mean {moment.mean():.4f}, 99 % {numpy.quantile(moment, 0.99):.3f}, "
        f"largest {moment.max():.3f}",
        flush=True,
    )
    return (errors**2 * (1 + (errors / LARGE) ** 2)).mean()


def main():
    rows = numpy.loadtxt(sys.argv[1], delimiter=",")
    contacts = Contacts(rows)
    number = numpy.arange(len(contacts))
    judges, learned = contacts.pick(number % 10 == 9), contacts.pick(number % 10 != 9)
    report("without a net", numpy.zeros(len(start(0))), judges)
    few = learned.pick(slice(0, None, 3))
    starts = [least(start(SEED + k), few, FEW) for k in range(STARTS)]
    scores = [report(f"start {k + 1}", weights, judges) for k, weights in enumerate(starts)]
    weights = least(starts[int(numpy.argmin(scores))], learned, ALL)
    report("all", weights, judges)
    weights = least(weights, learned, TAIL, LARGE)
    report("what it learned from", weights, learned)
    report("the others", weights, judges)
    Path(sys.argv[2]).write_bytes(weights.astype("<f4").tobytes())


main()
