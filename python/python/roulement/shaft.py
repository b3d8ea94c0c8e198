"""Shafts and housings from other programs for scenes with a shaft: matrices, reduced to the stations where bearings sit and loads act.

`roulement run` reads the file as `shaft.matrices` or `housing.matrices` (docs/shaft.md). Coordinates are displacements [m] and rotations [rad] of nodes, or
amplitudes of modes; x is the axis of the shaft.
"""

import json
from pathlib import Path

import numpy as np

from .scene import Scene
from .scene import package as write_package


def reduce(mass, stiffness, interface, highest, gyroscopic=None):
    """Reduces a structure to the coordinates of its interface and the modes between them (Craig and Bampton 1968).

    `interface` are indices of coordinates to keep, `highest` is the largest frequency of modes to keep [Hz], while the interface is held.
    Returns a dict of the reduced matrices `mass`, `stiffness`, `gyroscopic`, the `shapes` (coordinates of the whole by the reduced ones) and
    the `frequencies` of the modes [Hz]. The interface's coordinates come first, in the order given.

    Matrices may be sparse ones of SciPy. They are then factorised as such, and only the modes that are kept are computed: for thousands of
    coordinates, of which few modes are wanted.
    """
    sparse = hasattr(mass, "tocsc") and hasattr(stiffness, "tocsc")
    mass, stiffness = (matrix.tocsc() if sparse else np.asarray(matrix, float) for matrix in (mass, stiffness))
    outer = np.asarray(interface)
    inner = np.setdiff1d(np.arange(mass.shape[0]), outer)
    part = lambda matrix, rows, columns: matrix[rows][:, columns]
    static, values, modes = (_sparse_modes if sparse else _dense_modes)(
        part(mass, inner, inner), part(stiffness, inner, inner), part(stiffness, inner, outer), (2 * np.pi * highest) ** 2
    )
    shapes = np.zeros((mass.shape[0], len(outer) + len(values)))
    shapes[outer, np.arange(len(outer))] = 1
    shapes[np.ix_(inner, np.arange(len(outer)))] = -static
    shapes[np.ix_(inner, np.arange(len(outer), shapes.shape[1]))] = modes
    of = lambda matrix: shapes.T @ matrix @ shapes
    reduced = {"mass": of(mass), "stiffness": of(stiffness), "shapes": shapes, "frequencies": np.sqrt(np.maximum(values, 0)) / (2 * np.pi)}
    reduced["gyroscopic"] = np.zeros_like(reduced["mass"]) if gyroscopic is None else of(gyroscopic if sparse else np.asarray(gyroscopic, float))
    return reduced


def _dense_modes(mass, stiffness, coupling, highest):
    """Solution of `stiffness x = coupling`; eigenvalues up to `highest` [1/s2] and modes, of unit mass."""
    lower = np.linalg.cholesky(mass)
    half = np.linalg.solve(lower, stiffness)
    scaled = np.linalg.solve(lower, half.T)
    values, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
    kept = values <= highest
    return np.linalg.solve(stiffness, coupling), values[kept], np.linalg.solve(lower.T, vectors[:, kept])


def _sparse_modes(mass, stiffness, coupling, highest):
    """The same of sparse matrices: Lanczos's method on the inverse, for ever more modes until one is above `highest`."""
    from scipy.sparse.linalg import LinearOperator, eigsh, splu

    size = mass.shape[0]
    # The stiffness is symmetric and positive definite: no pivots.
    solve = splu(stiffness, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}).solve
    static = solve(coupling.toarray())
    # The same start every time, for the same bits.
    start = np.random.default_rng(0).standard_normal(size)
    count, values, vectors = 12, np.zeros(0), np.zeros((size, 0))
    while len(values) == 0 or values[-1] <= highest:
        count *= 2
        if count >= size:
            return _dense_modes(mass.toarray(), stiffness.toarray(), coupling.toarray(), highest)
        inverse = LinearOperator((size, size), matvec=solve, dtype=float)
        values, vectors = eigsh(stiffness, count, mass, sigma=0.0, OPinv=inverse, v0=start)
        order = np.argsort(values)
        values, vectors = values[order], vectors[:, order]
    kept = values <= highest
    return static, values[kept], vectors[:, kept]


def write(path, mass, stiffness, translations, stations, *, weights=None, gyroscopic=None, damping=None, polar_inertia=0.0, title=""):
    """Writes the matrices of a shaft for `shaft.matrices`, or of a housing for `housing.matrices`.

    `translations`, shape (n, 3), are the coordinates of a unit displacement of the whole along x, y, z. `stations` has for each position
    along the shaft [m], or place (x, y, z) [m], the map there: displacement x, y, z [m] and rotation about x, y, z [rad] by the coordinates, shape (6, n).
    A structure that is held cannot be displaced as a whole: then `translations` is None, and `weights`, shape (n, 3), are the generalised forces of
    an acceleration of 1 m/s2 along x, y, z [kg, kg m]. After a reduction: `shapes.T @ (mass @ unit)[free]`, with the mass of all coordinates, held ones
    too, and those of a displacement of everything by 1 along x, y, z.
    `gyroscopic` is that of a spin of 1 rad/s. `polar_inertia` is the moment of inertia about the axis [kg m2].
    """
    if (translations is None) == (weights is None):
        raise ValueError("either translations or weights: the one that is not given is None")
    if translations is None:
        # The file has coordinates whose weights, by the mass, are these: the rigid displacement as near as the coordinates come to it.
        translations = np.linalg.solve(np.asarray(mass, float), np.asarray(weights, float))
    rows = lambda matrix: np.asarray(matrix, float).tolist()
    optional = {"gyroscopic": gyroscopic, "damping": damping}
    file = {"title": title, "mass": rows(mass), "stiffness": rows(stiffness), "translations": rows(translations)}
    file["polar_inertia"] = float(polar_inertia)
    file |= {name: rows(matrix) for name, matrix in optional.items() if matrix is not None}
    file["stations"] = [{"position": np.asarray(position, float).tolist(), "map": rows(of)} for position, of in stations.items()]
    Path(path).write_text(json.dumps(file))


def package(file, path, library=None, name=None, columns=(), fmi=2):
    """Writes the FMI 2.0 or, with `fmi=3`, 3.0 package of a shaft with its bearings from its file; returns its path. Options as of `roulement.package`."""
    return write_package(Scene.load(file), path, library, name, columns, fmi)


def write_ross(path, rotor, nodes, highest):
    """Writes a rotor of ROSS (https://ross.readthedocs.io), reduced to some of its nodes and the modes up to `highest` [Hz].

    The rotor's own bearings are left out: it is one of shaft elements and discs, whose bearings are in our scene. It is taken as stiff in
    torsion.
    """
    elements = [*rotor.shaft_elements, *rotor.disk_elements]
    size = rotor.M().shape[0]
    mass, stiffness, gyroscopic = (np.zeros((size, size)) for _ in range(3))
    polar = 0.0
    for element in elements:
        at = list(element.dof_global_index.values())
        block = np.ix_(at, at)
        mass[block] += element.M()
        stiffness[block] += element.K()
        gyroscopic[block] += element.G()
        polar += element.Ip if hasattr(element, "Ip") else element.Im
    # ROSS has z along the axis, and six coordinates a node: x, y, z and the rotations about them. Without the turn about z.
    kept = np.array([6 * node + k for node in range(size // 6) for k in range(5)])
    block = np.ix_(kept, kept)
    interface = np.concatenate([5 * node + np.arange(5) for node in nodes])
    reduced = reduce(mass[block], stiffness[block], interface, highest, gyroscopic[block])
    shapes = reduced["shapes"]
    axes = {0: 2, 1: 0, 2: 1, 4: 3, 5: 4}  # our displacements and tilts by those of ROSS
    stations, count = {}, shapes.shape[1]
    translations = np.zeros((count, 3))
    for place, node in enumerate(nodes):
        of = np.zeros((6, count))
        for ours, theirs in axes.items():
            of[ours] = shapes[5 * node + theirs]
        stations[rotor.nodes_pos[node]] = of
        # A rigid displacement moves the interface and leaves modes at rest.
        for ours in range(3):
            translations[5 * place + axes[ours], ours] = 1
    write(path, reduced["mass"], reduced["stiffness"], translations, stations, gyroscopic=reduced["gyroscopic"], polar_inertia=polar,
          title=f"ROSS rotor, nodes {list(nodes)}")
