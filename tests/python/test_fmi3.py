"""Packages of FMI 3.0 in FMPy: validation, and the same results as those of FMI 2.0."""

import os

import numpy as np
import pytest
from conftest import ROOT, pose_drive, roulement
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

SCENES = ["thrust.toml", "cage.toml", "shafts/pinion.toml"]
EVERY = sorted(str(scene.relative_to(ROOT)) for folder in ["scenes", "examples"] for scene in (ROOT / folder).rglob("*.toml"))


def both(scene, directory, *options):
    """Packages of both versions of a scene's file."""
    made = []
    for version in [2, 3]:
        package = directory / str(version) / "bearing.fmu"
        package.parent.mkdir(exist_ok=True)
        roulement("fmu", scene, "-o", package, "--fmi", version, *options)
        made.append(str(package))
    return made


def outputs(package, steps=40, step=5e-5, **options):
    description = read_model_description(package)
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    return simulate_fmu(package, stop_time=steps * step, output_interval=step, output=names, **options)


@pytest.mark.parametrize("scene", SCENES)
def test_results_are_those_of_2_0_to_the_last_bit(scene, tmp_path):
    packages = both(ROOT / "scenes" / scene, tmp_path)
    assert [validate_fmu(package) for package in packages] == [[], []]
    results = [outputs(package) for package in packages]
    assert results[0].dtype.names == results[1].dtype.names and len(results[0].dtype.names) > 20
    for name in results[0].dtype.names:
        assert np.array_equal(results[0][name], results[1][name]), name
    assert len({row.tobytes() for row in results[0]}) == 41


def test_results_are_those_of_2_0_with_inputs_driven(thrust_text, tmp_path):
    scene = tmp_path / "driven.toml"
    scene.write_text(pose_drive(thrust_text, "shaft"))
    times = np.linspace(0, 2e-3, 41)
    signals = np.zeros(41, dtype=[("time", float), ("inner.position.y", float), ("inner.velocity.y", float), ("friction", float)])
    signals["time"], signals["friction"] = times, np.where(times < 1e-3, 0.1, 0.03)
    signals["inner.position.y"], signals["inner.velocity.y"] = 2e-6 * np.sin(3e3 * times), 6e-3 * np.cos(3e3 * times)
    # FMPy gives 2.0 packages derivatives of inputs, 3.0 has none.
    packages = both(scene, tmp_path)
    results = [outputs(package, input=signals, set_input_derivatives=False) for package in packages]
    for name in results[0].dtype.names:
        assert np.array_equal(results[0][name], results[1][name]), name
    assert np.ptp(results[0]["inner.force.y"]) > 50


def validated(scene, directory):
    result = roulement("fmu", ROOT / scene, "-o", directory / "probe.fmu", check=False)
    if result.returncode != 0:
        # Descriptions of sweeps and systems, and scenes that are part of others, have no package.
        return None
    return [validate_fmu(package) for package in both(ROOT / scene, directory)]


@pytest.mark.skipif("ROULEMENT_LONG" not in os.environ, reason="long: scripts/soak")
@pytest.mark.parametrize("scene", EVERY)
def test_fmpy_finds_no_problem_in_any_scene_that_is_shipped(scene, tmp_path):
    assert validated(scene, tmp_path) in (None, [[], []])
