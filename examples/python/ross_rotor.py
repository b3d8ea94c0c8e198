"""A rotor in ROSS on two 7206 B with their stiffness over speed. Needs `pip install -r examples/python/ross-requirements.txt`."""

import numpy as np
import ross
import roulement

RPM = np.pi / 30
speeds = np.linspace(0, 18000, 7) * RPM  # [rad/s]
scene = roulement.catalogue.bearing("7206 B").with_({"load.x.force": "1 kN", "rating": None})


def stiffness(speed):
    """Stiffness (3 x 3) along the axes of ROSS, whose z is the shaft's axis, our x; tilts are held [N/m]."""
    ours = roulement.equilibrium(scene.with_({"load.inner_speed": speed})).stiffness[:3, :3]
    return np.roll(ours, -1, axis=(0, 1))


def rotor(tables):
    """A steel shaft of 30 mm and 0.4 m with a disk in its middle, a bearing near each end."""
    steel = ross.Material("steel", rho=7800, E=206e9, Poisson=0.3)
    shaft = [ross.ShaftElement(L=0.05, idl=0.0, odl=0.03, material=steel) for _ in range(8)]
    disk = ross.DiskElement.from_geometry(n=4, material=steel, width=0.03, i_d=0.03, o_d=0.16)
    names = {(i, j): f"k{'xyz'[i]}{'xyz'[j]}" for i in range(3) for j in range(3) if i == j or max(i, j) < 2}
    springs = {name: tables[:, i, j] for (i, j), name in names.items()}
    bearings = [ross.BearingElement(n=n, cxx=200.0, czz=200.0, frequency=speeds, **springs) for n in (1, 7)]
    return ross.Rotor(shaft, [disk], bearings)


tables = np.array([stiffness(speed) for speed in speeds])
ours, stiff = rotor(tables), rotor(np.broadcast_to(tables[0], tables.shape))
print(f"radial stiffness {tables[0, 0, 0] * 1e-6:.1f} N/um at rest, {tables[-1, 0, 0] * 1e-6:.1f} at {speeds[-1] / RPM:.0f} rpm")
for speed in speeds[[0, 3, 6]]:
    modes = [model.run_modal(speed, num_modes=16).wn[:4] / (2 * np.pi) for model in (ours, stiff)]
    print(f"{speed / RPM:6.0f} rpm: bending modes {np.round(modes[0], 1)} Hz; with the stiffness at rest {np.round(modes[1], 1)} Hz")
