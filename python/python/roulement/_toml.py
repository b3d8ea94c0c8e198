"""Values of Python as a scene file has them."""

import json

import numpy as np

BLOCKS = {"ramp", "step", "amplitude", "frequency", "table", "file", "sum"}
"""Keys of building blocks of values over time: a dictionary with one of them is a value, and no section."""


def to_toml(value):
    """Text of a value in TOML: numbers, texts, lists (arrays too) and tables of these.

    Raises TypeError for anything else.
    """
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        # The escapes of JSON are among those of TOML.
        return json.dumps(value)
    if isinstance(value, np.ndarray):
        return to_toml(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(to_toml, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {to_toml(of)}" for key, of in value.items()) + " }"
    raise TypeError(f"{value!r} is no number, text, list or table")


def flat(settings, prefix=""):
    """Keys with their sections and values: {"load": {"x": 1}} and {"load.x": 1} are the same."""
    for key, value in settings.items():
        if isinstance(value, dict) and not BLOCKS & value.keys():
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
