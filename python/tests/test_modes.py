"""Small motions about the running state: as the command line has them."""

import json
import math

import numpy as np
import pytest
import roulement
from conftest import ROOT, program


@pytest.mark.parametrize("name, time", [("whirl/one", 0.0), ("shafts/pinion", 1e-3)])
def test_consistency_motions_are_those_of_the_command_line(name, time):
    """Of a bearing that whirls, and of a shaft."""
    path = ROOT / "scenes" / f"{name}.toml"
    options = ("--time", time, "--after", "1e-3", "--speeds", "2", "--up-to", "2500")
    printed = json.loads(program("modes", path, "--json", *options).stdout)
    found = roulement.modes(roulement.Scene.load(path), time=time, after=1e-3, up_to=2500.0, speeds=2)
    assert found.report == printed
    assert [motions.speed for motions in found.speeds] == [1250.0, 2500.0]
    for motions, row in zip([found.own, *found.speeds], [printed["own"], *printed["speeds"]], strict=True):
        assert motions.error is None and len(motions.shape) == len(row["motions"]) > 0
        assert motions.shape == [motion["shape"] for motion in row["motions"]]
        for key in ("frequency", "growth", "growth_spread", "damping", "balls", "grows"):
            of_row = [math.nan if motion[key] is None else motion[key] for motion in row["motions"]]
            assert np.array_equal(getattr(motions, key), of_row, equal_nan=True), key
        assert motions.damping == pytest.approx(-motions.growth / np.hypot(motions.growth, math.tau * motions.frequency), rel=1e-12)
        assert (np.diff(motions.frequency) >= 0).all()


def test_independent_data_a_free_ring_whirls_and_on_two_bearings_does_not():
    """Growth at 24,000 rpm in runs that were kicked (tests/analysis/small_motions.rs): 112 1/s."""
    speed = 24_000 * math.tau / 60
    one = roulement.Scene.load(ROOT / "scenes" / "whirl" / "one.toml").with_({"load.inner_speed": speed})
    own = roulement.modes(one, speeds=0).own
    assert own.grows.sum() == 1 and own.growth[own.grows][0] == pytest.approx(112, rel=0.05)
    assert own.shape[int(np.argmax(own.grows))] == "inner ring tilts and shifts forward"
    (two,) = roulement.modes(roulement.Scene.load(ROOT / "scenes" / "whirl" / "two.toml"), up_to=speed, speeds=1).speeds
    assert len(two.growth) > 0 and not two.grows.any() and two.growth.max() < 0


def test_consistency_runs_say_what_grows_as_the_command_line_does(tmp_path):
    path = ROOT / "scenes" / "whirl" / "one.toml"
    printed = json.loads(program("run", path, "-o", tmp_path / "out", "--json").stdout)
    summary = roulement.run(roulement.Scene.load(path)).summary
    assert summary["warnings"] == printed["warnings"] and summary["warnings"][0].startswith("a motion grows: inner ring")
    assert summary["means"]["settled"] is printed["means"]["settled"] is False


def test_what_cannot_move_has_no_motions_and_what_cannot_be_is_refused(posed):
    held = roulement.modes(posed, speeds=1)
    assert held.own.shape == [] and held.own.error is None and held.own.growth.shape == (0,)
    for arguments, said in [
        ({"time": -1e-3}, r"time = -0.001 s is out of \[0, inf\)"),
        ({"after": math.nan}, r"after = NaN s is out of \[0, inf\)"),
        ({"up_to": 0.0}, r"up_to = 0 rad/s is out of \(0, 100000\]"),
        ({"speeds": -1}, r"speeds = -1 is out of \[0, 1000\]"),
        ({"speeds": 1001}, r"speeds = 1001 is out of \[0, 1000\]"),
    ]:
        with pytest.raises(ValueError, match=said):
            roulement.modes(posed, **arguments)
