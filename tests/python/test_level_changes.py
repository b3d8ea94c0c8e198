"""A package whose bearings change their level between communication steps."""

import numpy as np
import pytest
from conftest import Slave, build
from fmpy.validation import validate_fmu
from test_shaft_package import TEXT

STEP = 5e-5


def changing(level):
    """The scene with a left bearing that begins at this level and may change it."""
    return TEXT.replace('name = "left"\n', f'name = "left"\nlevel = "{level}"\nlevel_changes = true\n', 1)


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    return build(changing("equilibrium"), tmp_path_factory.mktemp("levels"), "levels")


@pytest.fixture
def unit(package, tmp_path):
    made = Slave(package, tmp_path / "unit").start()
    yield made
    made.close()


def steps(unit, first, last):
    rows = []
    for k in range(first, last):
        unit.fmu.doStep(k * STEP, STEP)
        rows.append(unit.get(*(f"{side}.inner.force.{axis}" for side in ["left", "right"] for axis in "xyz")))
    return np.array(rows)


def test_the_model_description_offers_the_level(package, unit):
    assert validate_fmu(str(package)) == []
    offered = {v.name: v for v in unit.description.modelVariables}
    level = offered["left.dynamic"]
    assert (level.causality, level.variability, level.start) == ("parameter", "tunable", "0.0")
    assert "right.dynamic" not in offered and "right.level.changes" not in offered
    assert offered["left.level.force_jump"].unit == "N"


def test_seconds_that_matter_are_simulated_in_full(unit):
    """Loads of both levels agree in the mean, the jump is said where it is made, and the log tells of it."""
    cheap = steps(unit, 0, 40)
    assert unit.get("left.level.changes", "left.level.force_jump") == [0, 0]
    unit.set(left__dynamic=1.0)
    full = steps(unit, 40, 80)
    [changes, jump] = unit.get("left.level.changes", "left.level.force_jump")
    load = np.linalg.norm(cheap[-1][:3])
    assert changes == 1 and 0 < jump < 0.05 * load, (jump, load)
    told = [text for _, category, text in unit.messages if category == "logEvents"]
    assert any("bearing left: from 0.002 s on level = \"dynamic\"" in text and " N m" in text for text in told), told
    # What was cheap before is so again.
    unit.set(left__dynamic=0.0)
    again = steps(unit, 80, 120)
    assert unit.get("left.level.changes") == [2]
    for rows in [full, again]:
        assert np.allclose(rows[20:].mean(0), cheap[20:].mean(0), atol=0.02 * load), (rows[20:].mean(0), cheap[20:].mean(0))


def test_a_state_goes_back_over_a_change(unit, package, tmp_path):
    steps(unit, 0, 5)
    saved = unit.state_bytes()
    runs = []
    for _ in range(2):
        unit.fmu.setFMUState(unit.fmu.deserializeFMUState(saved))
        assert unit.get("left.dynamic") == [0]
        unit.set(left__dynamic=1.0)
        runs.append(steps(unit, 5, 15))
    assert np.array_equal(*runs)
    # A state with states goes into an instance that has not changed.
    full = unit.state_bytes()
    other = Slave(package, tmp_path / "other").start()
    other.fmu.setFMUState(other.fmu.deserializeFMUState(full))
    assert other.get("left.dynamic", "left.level.changes") == [1, 1]
    assert np.array_equal(steps(unit, 15, 20), steps(other, 15, 20))
    other.close()


def test_a_level_set_before_the_start_is_that_of_the_scene(package, tmp_path):
    set_before = Slave(package, tmp_path / "set").instantiate()
    set_before.set(left__dynamic=1.0)
    set_before.start()
    written = Slave(build(changing("dynamic"), tmp_path, "written"), tmp_path / "written").start()
    assert np.array_equal(steps(set_before, 0, 10), steps(written, 0, 10))
    set_before.close()
    written.close()


def test_numbers_between_levels_are_refused_and_nothing_is_lost(unit):
    steps(unit, 0, 2)
    with pytest.raises(Exception):
        unit.set(left__dynamic=0.5)
    assert "left.dynamic = 0.5 is out of range: allowed is whole numbers in [0, 1]" in unit.messages[-1][2]
    unit.set(left__dynamic=1.0)
    steps(unit, 2, 3)
    assert unit.get("left.level.changes") == [1]
