"""Kalker's linear theory as src/kalker/linear.rs states it (degree 9, 96 points on the edge), solved with 50 digits.

Writes linear_theory_digits.csv to standard output. Needs mpmath; half a minute.
"""

from mpmath import binomial, cos, fac2, lu_solve, matrix, mp, mpf, nstr, pi, sin, sqrt

mp.dps = 50
DEGREE, EDGE_POINTS = 9, 96
POWERS = [(total - q, q) for total in range(DEGREE + 1) for q in range(total + 1)]
INDEX = {powers: i for i, powers in enumerate(POWERS)}
N = len(POWERS)


def integrals(nu, a, b):
    """Integrals of A(t)/rho(t) cos^c sin^(d - c) over half a turn, by d and c."""
    points = 1500 if max(a / b, b / a) > 11 else 800
    result = {(f, d, c): mpf(0) for f in range(3) for d in range(0, 2 * DEGREE + 1, 2) for c in range(d + 1)}
    for k in range(points // 2):
        t = pi * (k + mpf(1) / 2) / points
        dx, dy = a * cos(t), b * sin(t)
        rho = sqrt(dx * dx + dy * dy)
        weight = 2 * pi / points / rho
        factors = [1 - nu + nu * dx * dx / rho**2, nu * dx * dy / rho**2, 1 - nu + nu * dy * dy / rho**2]
        cosines, sines = [mpf(1)], [mpf(1)]
        for _ in range(2 * DEGREE):
            cosines.append(cosines[-1] * cos(t))
            sines.append(sines[-1] * sin(t))
        for d in range(0, 2 * DEGREE + 1, 2):
            for c in range(d + 1):
                for f in [1] if c % 2 else [0, 2]:
                    result[f, d, c] += weight * factors[f] * cosines[c] * sines[d - c]
    return result


def load_displacement(nu, a, b):
    integral = integrals(nu, a, b)
    result = [[mpf(0)] * (2 * N) for _ in range(2 * N)]
    for column, (p, q) in enumerate(POWERS):
        for i in range(p + 1):
            for j in range(i % 2, q + 1, 2):
                half = (i + j) // 2
                mean = fac2(2 * half - 1) / fac2(2 * half)
                first = (-1) ** (p - i) * binomial(p, i) * binomial(q, j) * mean
                for l in range(half + 1):
                    k = p + q - (i + j) + 2 * l
                    second = first * (-1) ** l * binomial(half, l)
                    for m in range(k + 1):
                        c, row = i + q - j + k - m, INDEX[m, k - m]
                        value = second * (-1) ** m * binomial(k, m)
                        if c % 2:
                            result[row][N + column] += value * integral[1, p + q + k, c]
                            result[N + row][column] += value * integral[1, p + q + k, c]
                        else:
                            result[row][column] += value * integral[0, p + q + k, c]
                            result[N + row][N + column] += value * integral[2, p + q + k, c]
    return result


def displacements(a, b):
    """Those of unit creepages, then those that do not change along rolling."""

    def column(*entries):
        result = [mpf(0)] * (2 * N)
        for row, value in entries:
            result[row] = value
        return result

    creepages = [
        column((INDEX[1, 0], -a)),
        column((N + INDEX[1, 0], -a)),
        column((INDEX[1, 1], a * b), (N + INDEX[2, 0], -a * a / 2)),
    ]
    free = [column((first + INDEX[0, k], b**k)) for k in range(DEGREE + 1) for first in (0, N)]
    return creepages + free


def tractions(stiffness, columns):
    def symmetry(row):
        p, q = POWERS[row % N]
        return p % 2 + 2 * (q % 2) if row < N else 3 - p % 2 - 2 * (q % 2)

    result = [[mpf(0)] * (2 * N) for _ in columns]
    for wanted in range(4):
        rows = [row for row in range(2 * N) if symmetry(row) == wanted]
        block = matrix([[stiffness[r][s] for s in rows] for r in rows])
        for k, column in enumerate(columns):
            if any(column[row] != 0 for row in rows):
                for row, value in zip(rows, lu_solve(block, matrix([column[row] for row in rows]))):
                    result[k][row] = value
    return result


def edge(traction, a, b):
    """The singular traction on the leading edge, weighted."""
    result = []
    for point in range(EDGE_POINTS):
        angle = 2 * pi * (point + mpf(1) / 2) / EDGE_POINTS
        x, y = cos(angle), sin(angle)
        facing = (x / a) / sqrt((x / a) ** 2 + (y / b) ** 2)
        for first in (0, N) if facing > 0 else ():
            values = (traction[first + i] * x**p * y**q for i, (p, q) in enumerate(POWERS))
            result.append(sqrt(facing / EDGE_POINTS) * sum(values))
    return result


def disc_moment(p, q):
    odd = lambda n: fac2(n - 1) if n else mpf(1)
    return mpf(0) if p % 2 or q % 2 else 2 * pi * odd(p) * odd(q) / fac2(p + q + 1)


def coefficients(nu, ratio):
    a, b = sqrt(ratio), 1 / sqrt(ratio)
    fields = tractions(load_displacement(nu, a, b), displacements(a, b))
    edges = [edge(field, a, b) for field in fields]
    free = matrix(edges[3:]).T
    net = []
    for unit in range(3):
        amounts = lu_solve(free.T * free, free.T * matrix([-value for value in edges[unit]]))
        total = [sum([fields[unit][row]] + [x * field[row] for x, field in zip(amounts, fields[3:])]) for row in range(2 * N)]
        each = list(enumerate(POWERS))
        net.append([
            sum(disc_moment(p, q) * total[i] for i, (p, q) in each),
            sum(disc_moment(p, q) * total[N + i] for i, (p, q) in each),
            sum(a * disc_moment(p + 1, q) * total[N + i] - b * disc_moment(p, q + 1) * total[i] for i, (p, q) in each),
        ])
    return net[0][0], net[1][1], net[2][1], net[1][2], net[2][2]


print("poisson_ratio,axis_ratio_rolling_over_transverse,c11,c22,c23,c32,c33")
for case in ["0.3 0.05", "0.3 0.1", "0.3 0.2", "0.3 1", "0.3 5", "0.5 0.07", "0 0.3", "0 0.5"]:
    nu, ratio = case.split()
    print(nu, ratio, *(nstr(value, 18) for value in coefficients(mpf(nu), mpf(ratio))), sep=",")
