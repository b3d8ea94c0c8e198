"""Vibration of a run, as it is measured on machines: levels, envelope spectra, orders.

>>> run = roulement.run("scenes/radial.toml", columns=["inner.acceleration.*"])
>>> levels(run.time, run["inner.acceleration"][:, 1]).velocity_rms

Signals are arrays over evenly spaced times [s], accelerations in m/s2.
"""

from dataclasses import dataclass

import numpy as np

ACCELERATION_REFERENCE = 1e-6
"""Of levels in dB [m/s2] (ISO 1683)."""
VELOCITY_REFERENCE = 1e-9
"""Of levels in dB [m/s] (ISO 1683)."""
_EVEN = 1e-6
_FAINT = 1e-4
"""Part of the power below which a band is none that blows are looked for in: a sensor would not tell it from its noise."""


@dataclass(frozen=True)
class Levels:
    """Figures of an acceleration."""

    rms: float
    """[m/s2]"""
    peak: float
    """Largest, without the mean [m/s2]."""
    crest_factor: float
    """Peak over rms [-]; 1.41 of a sine."""
    kurtosis: float
    """Fourth moment over the square of the second [-]; 3 of noise, more of blows."""
    velocity_rms: float
    """In a band, 10 Hz to 1 kHz if not given, as of ISO 20816 [m/s]."""

    @property
    def decibel(self):
        """Of the acceleration, over 1e-6 m/s2 [dB]."""
        return 20 * np.log10(self.rms / ACCELERATION_REFERENCE)

    @property
    def velocity_decibel(self):
        """Of the velocity, over 1e-9 m/s [dB]."""
        return 20 * np.log10(self.velocity_rms / VELOCITY_REFERENCE)


@dataclass(frozen=True)
class Spectrum:
    """Amplitudes over frequencies, or over orders."""

    frequency: np.ndarray
    """[Hz], of an order spectrum in turns [-]."""
    amplitude: np.ndarray
    """Of a sine of that frequency, in the unit of the signal; of an envelope, of its square."""
    band: tuple | None = None
    """Band that the envelope was taken of [Hz]."""

    def at(self, frequency, width=None):
        """Largest amplitude within half a `width` of a frequency, two lines of the spectrum if not given."""
        width = width or 2 * self.frequency[1]
        near = np.abs(self.frequency - frequency) <= 0.5 * width
        if not near.any():
            raise ValueError(f"{frequency} is beyond the spectrum, which ends at {self.frequency[-1]:.6g}")
        return self.amplitude[near].max()


def _rate(time):
    """Samples a second [1/s]. Raises ValueError where times are not even."""
    time = np.asarray(time, float)
    if len(time) < 8:
        raise ValueError(f"{len(time)} samples are too few: 8 or more")
    steps = np.diff(time)
    step = (time[-1] - time[0]) / (len(time) - 1)
    if not step > 0 or np.abs(steps - step).max() > _EVEN * step + 1e-12 * abs(time[-1]):
        raise ValueError("times are not evenly spaced: keep all rows of one output interval")
    return 1 / step


def levels(time, acceleration, band=(10.0, 1000.0)):
    """`Levels` of an acceleration [m/s2]. The velocity is its integral between the frequencies of `band` [Hz]."""
    rate = _rate(time)
    x = np.asarray(acceleration, float) - np.mean(acceleration)
    power = np.mean(x**2)
    if power == 0:
        raise ValueError("the signal is constant")
    spectrum, frequency = np.fft.rfft(x), np.fft.rfftfreq(len(x), 1 / rate)
    inside = (frequency >= band[0]) & (frequency <= band[1]) & (frequency > 0)
    velocity = np.where(inside, spectrum / (2j * np.pi * np.where(inside, frequency, 1)), 0)
    peak = np.abs(x).max()
    return Levels(
        rms=np.sqrt(power),
        peak=peak,
        crest_factor=peak / np.sqrt(power),
        kurtosis=np.mean(x**4) / power**2,
        velocity_rms=np.sqrt(np.mean(np.fft.irfft(velocity, len(x)) ** 2)),
    )


def _envelope(spectrum, frequency, band, count):
    """Square of the envelope of what is between two frequencies: of the analytic signal."""
    inside = (frequency >= band[0]) & (frequency < band[1])
    analytic = np.zeros(count, complex)
    analytic[: len(spectrum)][inside] = 2 * spectrum[inside]
    return np.abs(np.fft.ifft(analytic)) ** 2


def loudest_band(time, signal, lowest=0.0):
    """Band [Hz] in which blows stand out most: with the largest kurtosis of the complex envelope, of the bands of a kurtogram (halves, thirds, quarters,
    sixths and so on to 48ths of the range; Antoni 2007). Bands begin at `lowest` [Hz] or above."""
    rate = _rate(time)
    x = np.asarray(signal, float) - np.mean(signal)
    spectrum, frequency = np.fft.rfft(x), np.fft.rfftfreq(len(x), 1 / rate)
    best, found = -np.inf, None
    for parts in (2, 3, 4, 6, 8, 12, 16, 24, 32, 48):
        edges = np.linspace(0, rate / 2, parts + 1)
        for band in zip(edges[:-1], edges[1:]):
            if band[0] < lowest or (band[1] - band[0]) * len(x) / rate < 16:
                continue
            square = _envelope(spectrum, frequency, band, len(x))
            mean = square.mean()
            if mean < _FAINT * np.mean(x**2):
                continue
            kurtosis = np.mean(square**2) / mean**2 - 2
            if kurtosis > best:
                best, found = kurtosis, band
    if found is None:
        raise ValueError("no band has a signal")
    return tuple(float(edge) for edge in found)


def envelope(time, signal, band=None):
    """`Spectrum` of the square of the envelope of a signal in a band [Hz], that of `loudest_band` if not given: lines at the rate of blows and its
    multiples, with sidebands where they are modulated."""
    rate = _rate(time)
    x = np.asarray(signal, float) - np.mean(signal)
    band = tuple(band) if band is not None else loudest_band(time, signal)
    if not 0 <= band[0] < band[1] <= rate / 2 * (1 + 1e-12):
        raise ValueError(f"band = {band} Hz: its ends have to grow between 0 and half the rate of samples, {rate / 2:.6g} Hz")
    square = _envelope(np.fft.rfft(x), np.fft.rfftfreq(len(x), 1 / rate), band, len(x))
    return Spectrum(*_amplitudes(square - square.mean(), rate), band=band)


def orders(angle, signal, per_turn=None):
    """`Spectrum` of a signal over orders, lines a turn, of a shaft that may change its speed: the signal is taken at even angles [rad]. `per_turn` samples a
    turn, as many as there are in the fastest one if not given."""
    turns = np.asarray(angle, float) / (2 * np.pi)
    turns = turns if turns[-1] > turns[0] else -turns
    steps = np.diff(turns)
    if not (steps > 0).all():
        raise ValueError("the angle has to go one way")
    per_turn = per_turn or int(1 / steps.max())
    even = np.arange(turns[0], turns[-1], 1 / per_turn)
    if len(even) < 8:
        raise ValueError(f"{len(even)} samples over {turns[-1] - turns[0]:.3g} turns are too few: 8 or more")
    x = np.interp(even, turns, np.asarray(signal, float))
    return Spectrum(*_amplitudes(x - x.mean(), per_turn))


def _amplitudes(x, rate):
    """Frequencies and amplitudes of sines, through Hann's window."""
    window = np.hanning(len(x))
    return np.fft.rfftfreq(len(x), 1 / rate), 2 * np.abs(np.fft.rfft(x * window)) / window.sum()
