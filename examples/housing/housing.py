"""A flexible housing by scikit-fem for the pinion shaft of the gearbox: finite elements, reduction, and the run. docs/shaft.md explains it.

Usage: housing.py DIRECTORY [MILLISECONDS [DOCUMENT]]    (40 ms if not given; the program from ROULEMENT_BIN, or `roulement` on the path; tables are put
into the document)
Leaves there: housing.json, the scenes and results of the flexible and the rigid housing, and housing.png where matplotlib is installed.
Needs `pip install -r examples/housing/requirements.txt`.
"""

import importlib.util
import os
import subprocess
import sys
from functools import cached_property
from pathlib import Path

import numpy as np
import roulement.shaft
import skfem
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu

YOUNG, POISSON, DENSITY = 72e9, 0.33, 2680.0  # cast aluminium AlSi10Mg [Pa, -, kg/m3]
# A box without a lid on a plate: two end walls with a bore each and two side walls, in the axes of the shaft [m].
BORE, BLOCK = 0.031, 0.044  # radius of the bores, half the width of the end walls: 7206 B has 62 mm outside
WALLS = {"left": -0.05, "right": 0.05}  # their middles along the shaft, where the bearings are
THICK, SIDE, PLATE, BOTTOM = 0.016, 0.008, 0.012, -0.072  # of end walls, as wide as a bearing, of side walls, of the plate; its lower face
FLANGE = 0.024  # what the plate stands out by; its corners are clamped, from below, as far as the inner faces of the walls
LONG, WIDE = WALLS["right"] + THICK / 2 + FLANGE, BLOCK + SIDE + FLANGE  # half the length (x) and the width (y) of the plate
TOP = (WALLS["left"], 0.0, BLOCK)  # middle of the left wall's upper face: the shock is here
HIGHEST = 20e3  # modes up to here [Hz], while the interface is held
RATIO = 0.01  # damping ratio at the first frequency and at 5 kHz: proportional damping
SHOCK = 4000.0  # largest force [N], along -y, of a triangle of 0.5 ms at half of the run
GRAVITY = [0.0, 0.0, -9.81]  # [m/s2]


def divided(places, size):
    """Places [m] with more between them, no farther apart than a size [m]."""
    pieces = [np.linspace(a, b, int(np.ceil((b - a) / size - 1e-9)) + 1)[:-1] for a, b in zip(places, places[1:])]
    return np.append(np.concatenate(pieces), places[-1])


def mesh(size):
    """Hexahedra with 27 nodes, no longer than about a size [m]: a grid without what is not there, its square holes made round."""
    half = BORE * 0.75  # of the square hole
    x = divided([-LONG, *(wall + side * THICK / 2 for wall in WALLS.values() for side in (-1, 1)), LONG], size)
    y = divided([-WIDE, -BLOCK - SIDE, -BLOCK, -half, half, BLOCK, BLOCK + SIDE, WIDE], size)
    z = divided([BOTTOM, BOTTOM + PLATE, -BLOCK, -half, half, BLOCK], size)
    grid = skfem.MeshHex.init_tensor(x, y, z)
    at = grid.p[:, grid.t].mean(axis=1)
    ends = np.min([np.abs(at[0] - wall) for wall in WALLS.values()], axis=0) < THICK / 2
    ends &= (np.abs(at[1]) < BLOCK) & (np.abs(at[1:]).max(axis=0) > half)
    sides = (np.abs(at[0]) < LONG - FLANGE) & (np.abs(np.abs(at[1]) - BLOCK - SIDE / 2) < SIDE / 2)
    grid = grid.restrict(np.flatnonzero(ends | sides | (at[2] < BOTTOM + PLATE)))
    # From the hole to the block places move outwards: to the circle, not at all, and linearly between.
    curved = skfem.MeshHex2.from_mesh(grid)
    places = curved.doflocs.copy()
    square, circle = np.abs(places[1:]).max(axis=0), np.hypot(*places[1:])
    share = np.clip((BLOCK - square) / (BLOCK - half), 0, 1)
    inside = square < BLOCK - 1e-9
    places[1:, inside] *= ((1 - share) * BLOCK / square + share * BORE / circle)[inside]
    return skfem.MeshHex2(places, curved.t)


def assembled(mesh):
    """Places (3 x nodes) [m], mass and stiffness of linear elasticity: displacements of all nodes along x, then along y, then along z."""
    basis = skfem.Basis(mesh, skfem.ElementHex2(), intorder=4)
    assert np.all(basis.dx > 0)
    product = lambda i, j: skfem.BilinearForm(lambda u, v, _: u.grad[i] * v.grad[j]).assemble(basis)
    gradients = [[product(i, j) for j in range(3)] for i in range(3)]
    first, second = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)  # Lame
    shear = second * sum(gradients[i][i] for i in range(3))
    # Row k, column l: what a displacement along l does along k.
    blocks = [[first * gradients[l][k] + second * gradients[k][l] + (shear if k == l else 0 * shear) for l in range(3)] for k in range(3)]
    mass = DENSITY * skfem.BilinearForm(lambda u, v, _: u * v).assemble(basis)
    return basis.doflocs, sparse.kron(sparse.eye(3), mass).tocsc(), sparse.bmat(blocks).tocsc()


def rigid(places, about):
    """Displacements of places (3 x count) [m] with a point [m]: by its displacement and its rotation, shape (3 count, 6)."""
    x, y, z = places - np.reshape(about, (3, 1))
    one, no = np.ones_like(x), np.zeros_like(x)
    return np.vstack([np.column_stack(row) for row in ([one, no, no, no, z, -y], [no, one, no, -z, no, x], [no, no, one, y, -x, no])])


def tied(places, points, clamped):
    """All displacements by those that are left: six coordinates of each point (place [m], nodes that move with it) and the free nodes."""
    count, interface = places.shape[1], []
    free = ~clamped
    for place, nodes in points.values():
        block = np.zeros((3, count, 6))
        block[:, nodes] = rigid(places[:, nodes], place).reshape(3, -1, 6)
        interface.append(sparse.csc_array(block.reshape(-1, 6)))
        free = free & ~nodes
    return sparse.hstack([*interface, sparse.eye_array(3 * count, format="csc")[:, np.tile(free, 3)]]).tocsc()


class Housing:
    """Finite elements of the housing on clamped feet: `mass`, `stiffness` and `weights` in coordinates of which the first are six for each of
    its `points`, bores and place of the shock, in that order."""

    def __init__(self, size=0.02):
        self.mesh = mesh(size)
        self.places, mass, stiffness = assembled(self.mesh)
        x, y, z = self.places
        near = lambda values, value: np.abs(values - value) < 1e-6
        bore = near(np.hypot(y, z), BORE)
        top = near(z, TOP[2]) & (np.abs(x - TOP[0]) < THICK / 2 + 1e-6) & (np.abs(y) < BORE * 0.75 + 1e-6)
        self.points = {side: ((wall, 0.0, 0.0), bore & (np.abs(x - wall) < THICK / 2 + 1e-6)) for side, wall in WALLS.items()}
        self.points["top"] = (TOP, top)
        self.feet = near(z, BOTTOM) & (np.abs(x) > LONG - FLANGE - THICK - 1e-6) & (np.abs(y) > BLOCK - 1e-6)
        self.by = tied(self.places, self.points, self.feet)
        self.mass, self.stiffness = (self.by.T @ matrix @ self.by for matrix in (mass, stiffness))
        # Gravity pulls at all nodes, held ones too; what pulls at the free ones moves them.
        everywhere = np.kron(np.eye(3), np.ones((self.places.shape[1], 1)))
        self.weights = self.by.T @ (mass @ everywhere)
        self.total = everywhere[:, 0] @ mass @ everywhere[:, 0]
        self.interface = np.arange(6 * len(self.points))

    def at(self, point):
        """Indices of the six coordinates of a point."""
        return 6 * list(self.points).index(point) + np.arange(6)

    @cached_property
    def solved(self):
        """Function of generalised forces [N, N m] that gives coordinates [m, rad]: statics of all elements."""
        return splu(self.stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}).solve

    def compliance(self):
        """Displacement and rotation of the points by forces and moments there [m/N, ...]."""
        unit = np.eye(self.mass.shape[0], len(self.interface))
        return self.solved(unit)[self.interface]

    def frequencies(self, count):
        """The first frequencies of the free interface [Hz], of all elements."""
        inverse = LinearOperator(self.mass.shape, matvec=self.solved, dtype=float)
        values = eigsh(self.stiffness.tocsc(), count, self.mass.tocsc(), sigma=0.0, OPinv=inverse, return_eigenvectors=False)
        return np.sqrt(np.sort(values)) / (2 * np.pi)


def reduced(housing):
    """The reduced housing, with `damping`, `weights` and the `free` frequencies [Hz]."""
    of = roulement.shaft.reduce(housing.mass, housing.stiffness, housing.interface, HIGHEST)
    values = np.linalg.eigvals(np.linalg.solve(of["mass"], of["stiffness"])).real
    free = np.sqrt(np.sort(values)) / (2 * np.pi)
    # A damping ratio at two frequencies: half of mass part over, and stiffness part times, the circular frequency.
    low, high = 2 * np.pi * free[0], 2 * np.pi * 5e3
    scale = 2 * RATIO / (low + high)
    return of | {"damping": scale * (low * high * of["mass"] + of["stiffness"]), "weights": of["shapes"].T @ housing.weights, "free": free}


def write(path, housing, of):
    """Writes the reduced housing for `housing.matrices`: its interface points are the stations."""
    size = len(of["mass"])
    stations = {place: np.eye(size)[housing.at(point)] for point, (place, _) in housing.points.items()}
    # The feet are held: the housing has weights, but no displacement of the whole.
    roulement.shaft.write(path, of["mass"], of["stiffness"], None, stations, weights=of["weights"], damping=of["damping"], title="scikit-fem, aluminium box")


def scene(duration, flexible):
    """Text of the scene: pinion of the gearbox on two 7206 B, in the flexible housing or with fixed outer races."""
    seat = ', housing = "case"' if flexible else ""
    bearings = [
        f"""
[[bearing]]
name = "{side}"
catalogue = "7206 B"
mounting = {{ position = {WALLS[side]}, direction = "{direction}", preload = {{ force = "1500 N" }}{seat} }}
set = {{ effects = {{ per_ball_outputs = true }} }}
"""
        for side, direction in (("left", "+x"), ("right", "-x"))
    ]
    start = duration / 2
    case = f"""
[[housing]]
name = "case"
matrices = "housing.json"

[[housing.load]]
name = "shock"
position = {list(TOP)}
force = [0, [[0, 0], [{start}, 0], [{start + 0.25e-3}, {-SHOCK}], [{start + 0.5e-3}, 0]], 0]
"""
    return f"""title = "pinion on two 7206 B, {'flexible housing of finite elements' if flexible else 'rigid housing'}"
gravity = {GRAVITY}

[shaft]
speed = "6000 rpm"
mass = "1.8 kg"
polar_inertia = "6e-4 kg m^2"
transverse_inertia = "4e-3 kg m^2"

[[shaft.gear]]
torque = "30 N m"
pitch_radius = "23.8 mm"
pressure_angle = "20 deg"
helix_angle = "-15 deg"
offset = "-10 mm"
teeth = 23
ripple = 0.1
{case if flexible else ""}{"".join(bearings)}
[load]
duration = {duration}
output_interval = "20 us"
"""


def table(path):
    """Columns of a table by name, without units."""
    header = path.open().readline().rstrip().split(",")
    return dict(zip([title.split(" [")[0] for title in header], np.loadtxt(path, delimiter=",", skiprows=1).T))


def run(folder, duration, flexible):
    """Runs a scene of some seconds; returns its `results`."""
    name = "flexible" if flexible else "rigid"
    path = folder / f"{name}.toml"
    path.write_text(scene(duration, flexible))
    subprocess.run([os.environ.get("ROULEMENT_BIN", "roulement"), "run", path, "-o", folder / name], check=True, stdout=subprocess.DEVNULL)
    return results(folder / name)


def results(folder):
    """Columns of a run over time, SI: of the shaft, and of each bearing with its name in front."""
    found = table(folder / "shaft.csv")
    for side in WALLS:
        found |= {f"{side}.{column}": of for column, of in table(folder / side / "results.csv").items()}
    return found


def wrench(found, side, at):
    """Mean force and moment of a bearing on the housing [N, N m], in the axes of the shaft."""
    of = np.array([found[f"{side}.outer.{what}.{axis}"][at].mean() for what in ("force", "moment") for axis in "xyz"])
    return of if side == "left" else of * [-1, -1, 1, -1, -1, 1]


def moved(found, point, at):
    """Mean displacement and rotation of the housing at a point [m, rad]."""
    return np.array([found[f"case.{point}.{axis}"][at].mean() for axis in ("x", "y", "z", "rx", "ry", "rz")])


def by_statics(housing, found, at):
    """Coordinates of all elements under the bearing forces that a run reports, and under gravity [m, rad]."""
    force = housing.weights @ GRAVITY
    for side in WALLS:
        force[housing.at(side)] += wrench(found, side, at)
    return housing.solved(force)


def windows(found):
    """Rows of the start, of 10 ms before the shock (23 periods of the mesh; as many as there are in short runs), and after it."""
    time = found["time"]
    shock = time[-1] / 2
    return {"start": time == time[0], "before": (time > max(shock - 0.01, 0) + 1e-9) & (time < shock + 1e-9), "after": time > shock + 1e-9}


def loads(found, side, at):
    """Loads of all balls on the outer race in some rows [N]."""
    return np.array([of[at] for name, of in found.items() if name.startswith(f"{side}.ball[") and name.endswith("].outer.load")])


def report(housing, of, flexible, rigid):
    """What was found, as tables of Markdown."""
    at, join = windows(flexible), lambda values, digits: ", ".join(f"{value:.{digits}f}" for value in values)
    exact, small = housing.compliance(), np.linalg.inv(of["stiffness"])
    solved = by_statics(housing, flexible, at["before"])
    lines = ["| housing | all elements | reduced |", "|---|---:|---:|"]
    lines.append(f"| coordinates | {housing.mass.shape[0]} | {len(of['free'])} |")
    lines.append(f"| first frequencies [Hz] | {join(housing.frequencies(4), 0)} | {join(of['free'][:4], 0)} |")
    for side in WALLS:
        pair = (join(1e-6 / np.diag(which)[housing.at(side)[:3]], 1) for which in (exact, small))
        lines.append(f"| stiffness at the {side} bore along x, y, z [N/um] | {' | '.join(pair)} |")
    for side in WALLS:
        pair = (join(1e6 * which[:3], 3) for which in (solved[housing.at(side)], moved(flexible, side, at["before"])))
        lines.append(f"| the bearings push the {side} bore by x, y, z [um] | {' | '.join(pair)} |")
    still, largest = (np.mean(flexible["case.shock.y"][at["before"]]), flexible["case.shock.y"][at["after"]].min())
    static = exact[tuple(housing.at("top")[[1, 1]])] * SHOCK
    lines.append(f"| the shock pushes its point by [um] | {1e6 * static:.1f} (at rest) | {1e6 * (still - largest):.1f} (in the run) |")
    lines += ["", "| bearing | housing | axial force [N] | ball loads [N] | largest after the shock [N] | losses [W] |", "|---|---|---:|---:|---:|---:|"]
    for side in WALLS:
        for name, found in (("rigid", rigid), ("flexible", flexible)):
            before, after = (loads(found, side, at[part]) for part in ("before", "after"))
            axial, losses = abs(wrench(found, side, at["before"])[0]), found[f"{side}.friction_power"][at["before"]].mean()
            shock = f"{after.max():.0f}" if name == "flexible" else ""
            lines.append(f"| {side} | {name} | {axial:.0f} | {before.min():.0f} to {before.max():.0f} | {shock} | {losses:.1f} |")
    return "\n".join(lines)


def put(path, text):
    """Puts a text into a document, between `<!-- begin housing -->` and `<!-- end -->`."""
    begin, end = "<!-- begin housing -->", "<!-- end -->"
    head, rest = path.read_text().split(begin)
    path.write_text(f"{head}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")


def picture(housing, flexible, rigid, path):
    """The housing as the bearings bend it, ball loads over azimuth, and the shock over time."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import colormaps, pyplot
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    at = windows(flexible)
    figure = pyplot.figure(figsize=(12, 7.4), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=(1.25, 1.25, 1, 1))
    body = figure.add_subplot(grid[:, :2], projection="3d", computed_zorder=False)
    moved_by = (housing.by @ by_statics(housing, flexible, at["before"])).reshape(3, -1)
    scale = 0.006 / np.abs(moved_by).max()
    faces = housing.mesh.facets[:, housing.mesh.boundary_facets()].T
    size = np.linalg.norm(moved_by, axis=0) * 1e6
    shown = (housing.places + scale * moved_by).T * 1e3
    colours = colormaps["viridis"](size[faces].mean(axis=1) / size.max())
    body.add_collection3d(Poly3DCollection(shown[faces], facecolors=colours, edgecolors="black", linewidths=0.2))
    limits = [(shown[:, k].min(), shown[:, k].max()) for k in range(3)]
    body.set(xlim=limits[0], ylim=limits[1], zlim=limits[2], xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]", box_aspect=[b - a for a, b in limits])
    body.view_init(28, -55)
    body.set_title(f"displacement under the bearing forces, drawn {scale:.0f} times as large")
    figure.colorbar(pyplot.cm.ScalarMappable(pyplot.Normalize(0, size.max()), "viridis"), ax=body, shrink=0.5, label="[um]", location="left")
    for place, side in enumerate(WALLS):
        polar = figure.add_subplot(grid[0, 2 + place], projection="polar")
        for name, found, colour in (("rigid", rigid, "tab:gray"), ("flexible", flexible, "tab:red")):
            azimuth = np.array([of[at["before"]] for key, of in found.items() if key.startswith(f"{side}.ball[") and key.endswith("].azimuth")])
            azimuth = azimuth if side == "left" else np.pi - azimuth
            sector = np.floor(np.mod(azimuth, 2 * np.pi) / (2 * np.pi) * 36).astype(int)
            load = loads(found, side, at["before"])
            mean = [load[sector == k].mean() if np.any(sector == k) else np.nan for k in range(36)]
            polar.plot((np.arange(37) + 0.5) * np.pi / 18, [*mean, mean[0]], color=colour, label=f"{name} housing")
        polar.set_title(f"{side}: mean ball load [N]", fontsize=10)
        polar.set_xticks(np.radians([0, 90, 180, 270]), ["y", "z", "-y", "-z"])
        polar.set_rlabel_position(315)
        polar.set_ylim(0)
    polar.legend(loc="lower right", bbox_to_anchor=(1.15, -0.3), frameon=False, fontsize=8)
    lower = grid[1, 2:].subgridspec(2, 1)
    axes = [figure.add_subplot(lower[0])]
    axes.append(figure.add_subplot(lower[1], sharex=axes[0]))
    time = flexible["time"] * 1e3
    for point, colour in (("shock", "tab:blue"), ("left", "tab:red"), ("right", "tab:gray")):
        axes[0].plot(time, flexible[f"case.{point}.y"] * 1e6, lw=0.8, color=colour, label={"shock": "where the shock is"}.get(point, f"{point} bore"))
    for side, colour in (("left", "tab:red"), ("right", "tab:gray")):
        every = loads(flexible, side, slice(None))
        axes[1].fill_between(time, every.min(axis=0), every.max(axis=0), color=colour, alpha=0.4, lw=0, label=f"{side} bearing")
    shock = time[-1] / 2
    axes[0].set(title=f"shock of {SHOCK / 1e3:.0f} kN along -y: displacement y [um]", xlim=(shock - 1, min(shock + 4, time[-1])))
    axes[1].set(title="least and largest ball load [N]", xlabel="time [ms]", ylim=(0, 1.3 * axes[1].get_ylim()[1]))
    for one in axes:
        one.legend(loc="lower right" if one is axes[0] else "upper right", frameon=False, fontsize=8, ncols=3)
        one.title.set_fontsize(10)
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    duration = float(sys.argv[2]) * 1e-3 if len(sys.argv) > 2 else 0.04
    housing = Housing()
    of = reduced(housing)
    write(folder / "housing.json", housing, of)
    flexible, rigid = (run(folder, duration, which) for which in (True, False))
    print(f"{housing.mesh.t.shape[1]} elements, {housing.total:.2f} kg")
    said = report(housing, of, flexible, rigid)
    print(said)
    if len(sys.argv) > 3:
        put(Path(sys.argv[3]), said)
    if importlib.util.find_spec("matplotlib"):
        picture(housing, flexible, rigid, folder / "housing.png")
