"""Load cases: changes of a scene over time, to be given to `Scene.with_`.

>>> scene = roulement.Scene.load("scenes/thrust.toml").with_(load_cases.misalignment(rz=1e-3, start=0.01, rise=0.02))
"""


def ramp(before, after, start, rise):
    """A table over time [s] from one value to another: holds, goes up from `start` within `rise`, holds."""
    if not (start >= 0 and rise > 0):
        raise ValueError(f"start = {start}, rise = {rise}: start has to be at least 0, rise more")
    head = [[0.0, before]] if start > 0 else []
    return [*head, [start, before], [start + rise, after]]


def misalignment(ry=0.0, rz=0.0, start=0.0, rise=0.01):
    """The outer race is tilted about y and z [rad] from `start` [s] within `rise` [s]."""
    tilts = {"ry": ry, "rz": rz}
    return {f"outer.misalignment.{key}": ramp(0.0, tilt, start, rise) for key, tilt in tilts.items() if tilt != 0}


def loss_of_lubrication(before, after, start, rise=1e-3):
    """The friction coefficient of ball and race [-] changes at `start` [s] within `rise` [s]."""
    return {"friction.ball_race": ramp(before, after, start, rise)}


def speed(before, after, start, rise):
    """The inner race changes its speed [rad/s]."""
    return {"load.inner_speed": ramp(before, after, start, rise)}


def force(axis, before, after, start, rise):
    """The force on the loaded race along `axis`, "x", "y" or "z", changes [N]."""
    return {f"load.{axis}.force": ramp(before, after, start, rise)}
