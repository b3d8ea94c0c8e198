"""Numbers of an installed wheel to the last bit, to compare those of two machines. Usage: wheel_bits.py SCENE"""

import sys

import roulement

scene = roulement.Scene.load(sys.argv[1]).with_({"load.duration": "1 ms"})
print("version", roulement.__version__)
print("friction power", roulement.run(scene).mean("friction power")["mean"].hex())
stiffness = roulement.equilibrium(roulement.catalogue.bearing("7206 B")).stiffness
print("stiffness", *(float(value).hex() for value in stiffness.ravel()))
roulement.package(scene, "bits.fmu")
