"""Design of experiments: closed forms, and a small study of a bearing."""

import numpy as np
import pytest
from roulement import design

pytest.importorskip("SALib")
pytest.importorskip("scipy")


def test_closed_form_sobol_indices_of_ishigami():
    """sin a + 7 sin^2 b + 0.1 c^4 sin a over [-pi, pi]^3 (Ishigami and Homma, 1990)."""
    ranges = {key: (-np.pi, np.pi) for key in ("a", "b", "c")}

    def ishigami(cases):
        a, b, c = (np.array([case[key] for case in cases]) for key in ("a", "b", "c"))
        return {"f": np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)}

    found = design.sensitivity_of(ishigami, ranges, "sobol", 4096)
    # Parts of the variance: of a alone, of b, of a with c.
    of_a, of_b, with_c = 0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    total = of_a + of_b + with_c
    exact = np.array([of_a + with_c, of_b, with_c]) / total
    assert np.abs(found.strength["f"] - exact).max() < 0.02, (found.strength, exact)
    assert (found.error["f"] < 0.06).all()


def test_closed_form_elementary_effects_of_a_plane(tmp_path):
    ranges = {"x": ("2 mm", "6 mm"), "y": (0.0, 1.0), "z": (0.0, 1.0)}

    def plane(cases):
        assert all(case["x"].endswith(" mm") for case in cases)
        x = np.array([float(case["x"].split()[0]) for case in cases])
        return {"f": 3 * x - 2 * np.array([case["y"] for case in cases])}

    found = design.sensitivity_of(plane, ranges, "morris", 8)
    # Over the whole range each: 3 times 4 mm, 2, nothing.
    assert np.allclose(found.strength["f"], [12, 2, 0], rtol=1e-12, atol=1e-12)
    found.plot(tmp_path / "plane.svg")
    assert "elementary effects" in (tmp_path / "plane.svg").read_text()
    with pytest.raises(ValueError, match="same unit"):
        design.sobol({"x": ("2 mm", "6 um")}, 4)


@pytest.mark.parametrize("sample", [design.sobol, design.latin_hypercube])
def test_closed_form_samples_fill_their_ranges(sample):
    values = np.array([case["x"] for case in sample({"x": (2.0, 4.0), "y": (0.0, 1.0)}, 64)])
    assert sorted(((values - 2) / 2 * 64).astype(int)) == list(range(64))


def test_a_study_of_a_bearing_finds_what_matters(thrust, tmp_path):
    ranges = {"friction.ball_race": (0.04, 0.12), "load.x.force": ("1400 N", "1500 N"), "bearing.inner_conformity": (0.515, 0.53)}
    short = thrust.with_({"load.duration": "1 ms"})
    results = ["friction_power.mean", "ball.inner.load.largest"]
    found = design.sensitivity(short, ranges, results, tmp_path / "study", count=4)
    power, load = (found.strength[name] for name in results)
    # The load of a ball follows from the thrust: 100 N of it are 24 N a ball at 25 degrees.
    assert load[1] == pytest.approx(100 / 10 / np.sin(np.radians(25)), rel=0.25) and load[0] < 0.2 * load[1]
    assert power[0] > 2 * power[1]
    found.plot(tmp_path / "study.png")
    assert (tmp_path / "study.png").stat().st_size > 5000 and len(found.table) == 16
