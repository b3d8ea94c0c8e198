"""Shafts and housings from other programs for scenes with a shaft: matrices, reduced to the stations where bearings sit and loads act.

`roulement run` reads the file as `shaft.matrices` or `housing.matrices` (docs/shaft.md). Coordinates are displacements [m] and rotations [rad] of nodes, or
amplitudes of modes; x is the axis of the shaft.
"""

import json
from pathlib import Path

import numpy as np

from . import _native
from .scene import _package


def reduce(mass, stiffness, interface, highest, gyroscopic=None):
    """Reduces a structure to the coordinates of its interface and the modes between them (Craig and Bampton 1968).

    `interface` are indices of coordinates to keep, `highest` is the largest frequency of modes to keep [Hz], while the interface is held.
    Returns a dict of the reduced matrices `mass`, `stiffness`, `gyroscopic`, the `shapes` (coordinates of the whole by the reduced ones) and
    the `frequencies` of the modes [Hz]. The interface's coordinates come first, in the order given.
    """
    mass, stiffness = np.asarray(mass, float), np.asarray(stiffness, float)
    size = len(mass)
    outer = np.asarray(interface)
    inner = np.setdiff1d(np.arange(size), outer)
    static = -np.linalg.solve(stiffness[np.ix_(inner, inner)], stiffness[np.ix_(inner, outer)])
    lower = np.linalg.cholesky(mass[np.ix_(inner, inner)])
    half = np.linalg.solve(lower, stiffness[np.ix_(inner, inner)])
    scaled = np.linalg.solve(lower, half.T)
    values, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
    frequencies = np.sqrt(np.maximum(values, 0)) / (2 * np.pi)
    kept = frequencies <= highest
    modes = np.linalg.solve(lower.T, vectors[:, kept])
    shapes = np.zeros((size, len(outer) + kept.sum()))
    shapes[outer, np.arange(len(outer))] = 1
    shapes[np.ix_(inner, np.arange(len(outer)))] = static
    shapes[np.ix_(inner, np.arange(len(outer), shapes.shape[1]))] = modes
    of = lambda matrix: shapes.T @ np.asarray(matrix, float) @ shapes
    reduced = {"mass": of(mass), "stiffness": of(stiffness), "shapes": shapes, "frequencies": frequencies[kept]}
    reduced["gyroscopic"] = np.zeros_like(reduced["mass"]) if gyroscopic is None else of(gyroscopic)
    return reduced


def write(path, mass, stiffness, translations, stations, *, gyroscopic=None, damping=None, polar_inertia=0.0, title=""):
    """Writes the matrices of a shaft for `shaft.matrices`, or of a housing for `housing.matrices`.

    `translations`, shape (n, 3), are the coordinates of a unit displacement of the whole along x, y, z. `stations` has for each position
    along the shaft [m], or place (x, y, z) [m], the map there: displacement x, y, z [m] and rotation about x, y, z [rad] by the coordinates, shape (6, n).
    `gyroscopic` is that of a spin of 1 rad/s. `polar_inertia` is the moment of inertia about the axis [kg m2].
    """
    rows = lambda matrix: np.asarray(matrix, float).tolist()
    optional = {"gyroscopic": gyroscopic, "damping": damping}
    file = {"title": title, "mass": rows(mass), "stiffness": rows(stiffness), "translations": rows(translations)}
    file["polar_inertia"] = float(polar_inertia)
    file |= {name: rows(matrix) for name, matrix in optional.items() if matrix is not None}
    file["stations"] = [{"position": np.asarray(position, float).tolist(), "map": rows(of)} for position, of in stations.items()]
    Path(path).write_text(json.dumps(file))


def package(file, path, library=None, name=None):
    """Writes the FMI 2.0 package of a shaft with its bearings from its file; returns its path. Options as of `roulement.package`."""
    return _package(_native.package_shaft, Path(file), path, library, name)


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
