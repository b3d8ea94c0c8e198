"""Life over a duty: as the command line has it, and by hand."""

import json

import pytest
import roulement
from conftest import ROOT, program

SCENE = """
[bearing]
balls = 9
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
diametral_clearance = "10 um"
[rating]
dynamic_load_rating = "20 kN"
[load]
inner_speed = "1000 rpm"
y = { force = 1000 }
duration = "1 ms"
output_interval = "1 ms"
[[duty]]
name = "climb"
hours = 300
set = { load = { inner_speed = "600 rpm", y = { force = "6 kN" } } }
[[duty]]
name = "cruise"
hours = 4000
set = { "load.inner_speed" = "1500 rpm" }
"""


def test_a_duty_is_that_of_the_command_line_and_a_sum_by_hand(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    duty = roulement.rating(path)
    assert duty == roulement.equilibrium(path).duty
    assert duty == json.loads(program("equilibrium", path, "--json").stdout)["duty"]
    used = sum(hours / load["bearings"][""]["L10r_hours"] for hours, load in zip((300, 4000), duty["loads"]))
    of = duty["bearings"][""]
    assert of["L10r_hours"] == pytest.approx(4300 / used, rel=1e-12) and of["damage"] == pytest.approx(used, rel=1e-12)
    assert duty["machine"] is None and of["worst"]["load"] == "climb"


def test_loads_of_a_table_and_refusals(tmp_path):
    path, loads = tmp_path / "scene.toml", tmp_path / "loads.csv"
    path.write_text(SCENE.split("[[duty]]")[0])
    assert roulement.equilibrium(path).duty is None
    with pytest.raises(ValueError, match="there are no loads"):
        roulement.rating(path)
    loads.write_text("share,load.inner_speed [rpm],load.y.force [N]\n0.5,600,6000\n0.5,1500,\n")
    table = roulement.rating(path, loads)
    assert [load["share"] for load in table["loads"]] == [0.5, 0.5] and table["hours"] is None
    assert set(roulement.rating(ROOT / "scenes" / "shafts" / "pinion.toml", _shares(tmp_path))["bearings"]) == {"left", "right"}


def _shares(folder):
    path = folder / "shares.csv"
    path.write_text("share,shaft.speed [rpm]\n1,1000\n")
    return path


def test_a_duty_that_is_run_has_the_torque_of_its_runs(tmp_path):
    text = SCENE.replace('duration = "1 ms"', 'duration = "30 ms"')
    rated = roulement.rating(roulement.Scene.parse(text), runs=True)
    cruise = next(load for load in rated["loads"] if load["name"] == "cruise")["bearings"][""]
    run = roulement.run(roulement.Scene.parse(text).with_({"load.inner_speed": "1500 rpm"}))
    torque = next(mean["mean"] for mean in run.summary["means"]["quantities"] if mean["quantity"] == "friction torque")
    assert cruise["friction_torque"] == pytest.approx(abs(torque), rel=1e-12)
    assert cruise["friction_torque"] > 0.0


def test_fits_by_words_tell_three_clearances():
    fitted = {"growth.shaft": {"fit": "k6", "diameter": 0.03}, "growth.housing": {"fit": "N7", "diameter": 0.062, "outside": 0.09}}
    fits = roulement.equilibrium(roulement.Scene.parse(SCENE).with_(fitted)).fits
    assert [of["fits"] for of in fits] == ["least", "mean", "greatest"]
    assert fits[0]["clearance"] > fits[1]["clearance"] > fits[2]["clearance"]
    assert roulement.equilibrium(roulement.Scene.parse(SCENE)).fits is None
