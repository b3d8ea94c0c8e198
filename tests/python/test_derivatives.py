"""Directional derivatives against differences of steps repeated from a saved state."""

import numpy as np
import pytest
from conftest import Slave, build, pose_drive

AXES = "xyz"


def vector(name):
    return [f"{name}.{axis}" for axis in AXES]


WRENCH = vector("inner.force") + vector("inner.moment")
MOTION = vector("inner.position") + vector("inner.velocity") + vector("inner.angular_velocity")
POSE = vector("inner.position") + [f"inner.orientation.{c}" for c in "wxyz"]
TWIST = vector("inner.velocity") + vector("inner.angular_velocity")
SHAFT = vector("inner.position") + ["inner.rotation.y", "inner.rotation.z"]
SHAFT += vector("inner.velocity") + ["inner.rotation_rate.y", "inner.rotation_rate.z", "inner.speed"]
APPLIED = vector("inner.applied_force") + vector("inner.applied_moment")

# Changes that the wrench answers with some newtons: far above the solver's residual, far below what bends the contacts.
CHANGE = {"position": 2e-8, "orientation": 5e-7, "angle": 1e-6, "velocity": 2e-5, "angular_velocity": 1e-3}
CHANGE |= {"rotation": 1e-6, "rotation_rate": 1e-3}
CHANGE |= {"applied_force": 1.0, "applied_moment": 1e-2, "speed": 1e-2, "friction": 3e-4}


def change(name):
    return CHANGE[name.split(".")[1] if "." in name else name]


def jacobian(bearing, unknowns, knowns):
    """One column per known, from the FMU."""
    references = [bearing.references[name] for name in unknowns]
    columns = [bearing.fmu.getDirectionalDerivative(references, [bearing.references[k]], [1.0]) for k in knowns]
    return np.array(columns).T


def steps_from(bearing, state, values, time, step, unknowns):
    """Unknowns after a step from a saved state with changed inputs."""
    bearing.fmu.setFMUState(state)
    names = list(values)
    bearing.fmu.setReal([bearing.references[name] for name in names], [values[name] for name in names])
    bearing.fmu.doStep(time, step)
    return np.array(bearing.get(*unknowns))


def differences(bearing, state, time, step, unknowns, knowns):
    """The same by central differences."""
    bearing.fmu.setFMUState(state)
    inputs = [v.name for v in bearing.description.modelVariables if v.causality == "input"]
    base = dict(zip(inputs, bearing.get(*inputs)))
    columns = []
    for known in knowns:
        size = change(known)
        plus, minus = (
            steps_from(bearing, state, base | {known: base[known] + sign * size}, time, step, unknowns)
            for sign in (1, -1)
        )
        columns.append((plus - minus) / (2 * size))
    steps_from(bearing, state, base, time, step, unknowns)
    return np.array(columns).T


def assert_agree(analytic, reference, tolerance):
    """Compares column by column, each in units of the column's largest entry per kind of unknown (three at a time)."""
    assert np.isfinite(analytic).all()
    for first in range(0, len(analytic), 3):
        for column in range(analytic.shape[1]):
            a, b = analytic[first : first + 3, column], reference[first : first + 3, column]
            scale = np.abs(reference[first : first + 3]).max()
            assert np.abs(a - b).max() <= tolerance * scale, (first, column, a, b)


def run(bearing, steps, step, start=0.0):
    """Steps with a race that turns, if it is driven by its pose, steadily about its own axis: the inputs then agree with
    where the last step has led, as those of a shaft do. Ends with the inputs of the next step set."""
    inputs = {v.name for v in bearing.description.modelVariables if v.causality == "input"}
    turning = "inner.orientation.w" in inputs
    if turning:
        first = bearing.get(*POSE[3:])
        speed = np.linalg.norm(bearing.get(*TWIST[3:]))
        axis = turned(first, np.array([1.0, 0.0, 0.0]))
        bearing.set(**{name.replace(".", "__"): w for name, w in zip(TWIST[3:], axis * speed)})
    for k in range(steps):
        bearing.fmu.doStep(start + k * step, step)
        if turning:
            half = 0.5 * speed * (k + 1) * step
            now = product([np.cos(half), *(np.sin(half) * axis)], first)
            bearing.set(**{name.replace(".", "__"): c for name, c in zip(POSE[3:], now)})
    return start + steps * step


def product(p, q):
    """Product of quaternions w, x, y, z."""
    v, w = np.array(p[1:]), np.array(q[1:])
    return [p[0] * q[0] - v @ w, *(p[0] * w + q[0] * v + np.cross(v, w))]


def turned(q, vector):
    """A vector turned by a quaternion."""
    w, v = q[0], np.array(q[1:])
    return vector + 2 * np.cross(v, np.cross(v, vector) + w * vector)


@pytest.mark.parametrize("step", [2e-6, 1e-4, 6.4e-4])
def test_wrench_by_pose_and_twist(slave, step):
    bearing = slave("pose").start()
    # A tilted, shifted race breaks every symmetry.
    bearing.set(inner__position__y=1e-6, inner__orientation__y=2e-4)
    time = run(bearing, 30, 1e-4)
    state = bearing.fmu.getFMUState()
    reference = differences(bearing, state, time, step, WRENCH, POSE + TWIST)
    # The last thing that `differences` did is the step itself.
    analytic = jacobian(bearing, WRENCH, POSE + TWIST)
    bearing.fmu.freeFMUState(state)
    assert_agree(analytic, reference, 1e-5)
    # The bearing is stiff: pushing the race in a direction pushes back.
    assert analytic[0, 0] < -1e7 and analytic[1, 1] < -1e7 and analytic[2, 2] < -1e7


@pytest.mark.parametrize("step", [2e-6, 1e-4, 6.4e-4])
def test_wrench_by_place_and_rates_of_the_shaft(slave, step):
    bearing = slave("shaft").start()
    bearing.set(inner__position__y=1e-6, inner__rotation__y=4e-4)
    time = run(bearing, 30, 1e-4)
    state = bearing.fmu.getFMUState()
    reference = differences(bearing, state, time, step, WRENCH, SHAFT)
    analytic = jacobian(bearing, WRENCH, SHAFT)
    bearing.fmu.freeFMUState(state)
    assert_agree(analytic, reference, 1e-5)
    # Tilting about an axis is resisted about it.
    assert analytic[0, 0] < -1e7 and analytic[4, 3] < -10 and analytic[5, 4] < -10


@pytest.mark.parametrize("step", [2e-6, 1e-4, 6.4e-4])
def test_motion_by_applied_wrench(slave, step):
    bearing = slave("wrench, quaternion").start()
    bearing.set(inner__applied_force__y=100.0, inner__applied_moment__z=0.2)
    time = run(bearing, 30, 1e-4)
    state = bearing.fmu.getFMUState()
    knowns = APPLIED + ["inner.speed"]
    reference = differences(bearing, state, time, step, MOTION, knowns)
    analytic = jacobian(bearing, MOTION, knowns)
    bearing.fmu.freeFMUState(state)
    assert_agree(analytic, reference, 1e-5)
    assert analytic[0, 0] > 0 and analytic[1, 1] > 0 and analytic[2, 2] > 0


def test_both_races_and_every_output(thrust_text, tmp_path):
    text = pose_drive(thrust_text, "cardan").replace('drive = "fixed"', 'drive = "pose"')
    text = text.replace("[effects]", "[effects]\nper_ball_outputs = true")
    bearing = Slave(build(text, tmp_path, "both"), tmp_path / "unzipped").start()
    unknowns = [
        v.name for v in bearing.description.modelVariables if v.causality == "output" and v.type == "Real"
    ]
    knowns = [v.name for v in bearing.description.modelVariables if v.causality == "input"]
    # At rest, moving both races together changes no wrench.
    by_inner, by_outer = (jacobian(bearing, WRENCH, [f"{race}.position.x"]) for race in ("inner", "outer"))
    np.testing.assert_allclose(by_inner, -by_outer, rtol=0, atol=1e-6 * np.abs(by_inner).max())
    speed = bearing.get("inner.angular_velocity.x")[0]
    bearing.set(outer__position__x=1e-6, inner__angle__y=1e-4)
    for k in range(30):
        bearing.set(inner__angle__x=speed * k * 1e-4)
        bearing.fmu.doStep(k * 1e-4, 1e-4)
    time = 30e-4
    bearing.set(inner__angle__x=speed * time)
    state = bearing.fmu.getFMUState()
    reference = differences(bearing, state, time, 1e-4, unknowns, knowns)
    analytic = jacobian(bearing, unknowns, knowns)
    for row, name in enumerate(unknowns):
        # What hardly answers to anything is compared with what its size allows to see in differences.
        scale = np.abs(reference[row] * [change(known) for known in knowns]).max()
        floor = 1e-8 * abs(bearing.get(name)[0])
        for column, known in enumerate(knowns):
            error = abs(analytic[row, column] - reference[row, column]) * change(known)
            assert error <= 1e-3 * scale + floor, (name, known, analytic[row, column], reference[row, column])
    bearing.fmu.freeFMUState(state)
    bearing.close()


def test_any_subset_is_linear_in_the_changes(slave):
    bearing = slave("pose").start()
    run(bearing, 3, 1e-4)
    knowns = POSE + TWIST
    full = jacobian(bearing, WRENCH, knowns)
    random = np.random.default_rng(1)
    for _ in range(20):
        rows = random.permutation(len(WRENCH))[: random.integers(1, len(WRENCH) + 1)]
        columns = random.permutation(len(knowns))[: random.integers(1, len(knowns) + 1)]
        change = random.normal(size=len(columns))
        got = bearing.fmu.getDirectionalDerivative(
            [bearing.references[WRENCH[i]] for i in rows], [bearing.references[knowns[j]] for j in columns], list(change)
        )
        np.testing.assert_allclose(got, full[np.ix_(rows, columns)] @ change, rtol=1e-12, atol=1e-9)


def test_asking_changes_nothing(slave):
    asked, silent = slave("pose").start(), slave("pose").start()
    for k in range(5):
        for bearing in (asked, silent):
            bearing.fmu.doStep(k * 1e-4, 1e-4)
        jacobian(asked, WRENCH, POSE)
    assert asked.state_bytes() == silent.state_bytes()


def test_a_restored_state_gives_the_same_derivatives(slave):
    one, other = slave("pose").start(), slave("pose").start()
    run(one, 4, 1e-4)
    first = jacobian(one, WRENCH, POSE + TWIST)
    other.fmu.setFMUState(other.fmu.deserializeFMUState(one.state_bytes()))
    assert np.array_equal(jacobian(other, WRENCH, POSE + TWIST), first)


def test_before_the_first_step_they_are_those_of_the_equilibrium(slave):
    bearing = slave("pose").instantiate()
    bearing.fmu.setupExperiment(startTime=0.0)
    bearing.fmu.enterInitializationMode()
    start = bearing.get("inner.position.x")[0]
    analytic = jacobian(bearing, ["inner.force.x"], ["inner.position.x"])[0, 0]
    forces = []
    for sign in (1, -1):
        bearing.set(inner__position__x=start + sign * 2e-8)
        forces += bearing.get("inner.force.x")
    assert abs(analytic / ((forces[0] - forces[1]) / 4e-8) - 1) < 1e-4 and analytic < -1e7


@pytest.mark.parametrize(
    "unknowns, knowns",
    [
        (["inner.position.x"], ["inner.position.y"]),
        (["inner.force.x"], ["inner.force.y"]),
        (["integrator.steps"], ["inner.position.x"]),
    ],
)
def test_wrong_kinds_are_refused(slave, unknowns, knowns):
    bearing = slave("pose").start()
    bearing.fmu.doStep(0.0, 1e-4)
    with pytest.raises(Exception):
        jacobian(bearing, unknowns, knowns)
    name = knowns[0] if unknowns == ["inner.force.x"] else unknowns[0]
    assert name in bearing.messages[-1][2]
