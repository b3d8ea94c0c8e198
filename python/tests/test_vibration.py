"""Levels, envelopes and orders of signals whose lines are known."""

from pathlib import Path

import numpy as np
import pytest
import roulement
from roulement import vibration

RATE = 50e3


def blows(rate_of_blows, seconds=2.0, noise=0.5, modulated=None):
    """Blows that ring at 4.1 kHz and die away within 1 ms, with noise; loud once a turn of `modulated` [Hz]."""
    time = np.arange(int(seconds * RATE)) / RATE
    random = np.random.default_rng(7)
    signal = noise * random.standard_normal(len(time))
    for blow in np.arange(0.01, seconds, 1 / rate_of_blows):
        loud = 1.0 if modulated is None else 1 + 0.8 * np.cos(2 * np.pi * modulated * blow)
        after = time >= blow
        signal[after] += 5 * loud * np.exp(-(time[after] - blow) / 3e-4) * np.sin(2 * np.pi * 4100 * (time[after] - blow))
    return time, signal


def test_closed_form_levels_of_a_sine():
    time = np.arange(50_000) / RATE
    found = vibration.levels(time, 3 + 2.0 * np.sin(2 * np.pi * 100 * time))
    assert found.rms == pytest.approx(np.sqrt(2), rel=1e-9)
    assert found.crest_factor == pytest.approx(np.sqrt(2), rel=1e-6) and found.kurtosis == pytest.approx(1.5, rel=1e-9)
    assert found.velocity_rms == pytest.approx(2 / np.sqrt(2) / (2 * np.pi * 100), rel=1e-9)
    assert found.decibel == pytest.approx(20 * np.log10(np.sqrt(2) / 1e-6))
    # Beyond its band there is no velocity.
    assert vibration.levels(time, np.sin(2 * np.pi * 100 * time), band=(200, 1000)).velocity_rms < 1e-15


def test_closed_form_lines_of_an_outer_race_stand_out_of_noise_in_the_band_that_rings():
    # The outer race of a 6205 at 1797 rpm is struck 107.3 times a second.
    time, signal = blows(107.3)
    begin, end = vibration.loudest_band(time, signal)
    assert begin < 4100 < end
    of = vibration.envelope(time, signal)
    assert of.band == (begin, end)
    around = np.median(of.amplitude[(of.frequency > 50) & (of.frequency < 500)])
    for line in (107.3, 214.6, 321.9):
        assert of.at(line) > 30 * around
    assert of.at(150.0) < 10 * around
    assert vibration.levels(time, signal).kurtosis > 5


def test_closed_form_a_race_that_turns_has_sidebands_of_its_speed():
    time, signal = blows(162.2, noise=0.1, modulated=29.95)
    of = vibration.envelope(time, signal, band=(3000, 5200))
    for side in (162.2 - 29.95, 162.2 + 29.95, 29.95):
        assert of.at(side) > 0.1 * of.at(162.2)


def test_closed_form_orders_of_a_run_up():
    time = np.arange(100_000) / RATE
    angle = 2 * np.pi * (5 * time + 12 * time**2)
    of = vibration.orders(angle, 0.7 * np.sin(3.585 * angle) + 0.2 * np.sin(8 * angle))
    assert of.at(3.585) == pytest.approx(0.7, rel=0.05) and of.at(8) == pytest.approx(0.2, rel=0.05)
    assert of.at(6) < 0.01
    # The other way round there are the same.
    assert vibration.orders(-angle, 0.2 * np.sin(8 * angle)).at(8) == pytest.approx(0.2, rel=0.05)


def test_signals_that_cannot_be_are_refused():
    time = np.arange(100) / RATE
    with pytest.raises(ValueError, match="evenly"):
        vibration.levels(time**2, time)
    with pytest.raises(ValueError, match="constant"):
        vibration.levels(time, np.ones(100))
    with pytest.raises(ValueError, match="too few"):
        vibration.levels(time[:3], time[:3])
    with pytest.raises(ValueError, match="25000"):
        vibration.envelope(time, np.sin(time), band=(3000, 30000))
    with pytest.raises(ValueError, match="one way"):
        vibration.orders(np.sin(time * 1e5), time)


def test_regression_a_spall_is_told_by_levels_and_not_by_lines_over_the_rest():
    """Figures of docs/python.md."""
    file = Path(__file__).parents[2] / "scenes/effects/spall.toml"
    spalled = roulement.Scene.load(file).with_({"load.duration": "120 ms", "load.output_interval": "10 us"})
    found = {}
    for name, scene in (("spalled", spalled), ("whole", spalled.with_({"defect": None}))):
        run = roulement.run(scene, columns=["inner.acceleration.*"], window=(20e-3, None))
        acceleration = run["inner.acceleration"][:, 1]
        of = vibration.envelope(run.time, acceleration, band=(2e3, 10e3))
        median = np.median(of.amplitude[(of.frequency > 50) & (of.frequency < 2000)])
        line = of.at(178.58)
        found[name] = vibration.levels(run.time, acceleration).rms, line, line / median
    assert found["spalled"] == pytest.approx((1155, 3.6e6, 92), rel=0.1)
    assert found["whole"] == pytest.approx((0.069, 6e-3, 85), rel=0.1)


def test_published_lines_of_a_6205_at_1797_rpm():
    """Case Western Reserve University's bearing data: 9 balls of 7.94 mm on 39.04 mm; lines over the turns of the shaft 3.5848, 5.4152, 2.3567 (half of the
    4.7135 of both races), 0.3983."""
    scene = roulement.catalogue.bearing("6205").with_(
        {
            "bearing.ball_diameter": "7.94 mm",
            "bearing.pitch_diameter": "39.04 mm",
            "effects.frequency_outputs": True,
            "load.inner_speed": "1797 rpm",
            "load.duration": "0.2 ms",
        }
    )
    run = roulement.run(scene, columns=["frequency.*"])
    for line, expected in (("bpfo", 107.36), ("bpfi", 162.19), ("bsf", 70.58), ("ftf", 11.93)):
        # Rigid circles have the printed ones; under load balls and races are nearer by some 10 um, 5e-4 of the pitch radius.
        assert abs(run[f"frequency.{line}"][-1]) == pytest.approx(expected, rel=1e-3)
