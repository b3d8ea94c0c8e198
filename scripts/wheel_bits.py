"""Numbers of an installed wheel to the last bit, to compare those of two machines.
Usage: wheel_bits.py SCENE        prints them
       wheel_bits.py ONE OTHER    how far two such outputs are apart, of the largest number of each line; fails from 1e-12 on
"""

import sys
from pathlib import Path


def bits(scene):
    """Prints the numbers, and makes a package."""
    import roulement

    scene = roulement.Scene.load(scene).with_({"load.duration": "1 ms"})
    print("version", roulement.__version__)
    print("friction power", roulement.run(scene).mean("friction power")["mean"].hex())
    stiffness = roulement.equilibrium(roulement.catalogue.bearing("7206 B")).stiffness
    print("stiffness", *(float(value).hex() for value in stiffness.ravel()))
    roulement.package(scene, "bits.fmu")


def apart(one, other):
    """Prints the differences, and gives the largest."""
    largest = 0.0
    for lines in zip(*(Path(path).read_text().splitlines() for path in (one, other)), strict=True):
        words = [line.replace("friction power", "friction_power").split() for line in lines]
        name = words[0][0]
        assert name == words[1][0], lines
        if name == "version":
            assert words[0] == words[1], lines
            continue
        first, second = ([float.fromhex(word) for word in line[1:]] for line in words)
        difference = max(abs(a - b) for a, b in zip(first, second, strict=True)) / max(map(abs, first))
        print(f"{name}: {difference:.1g}")
        largest = max(largest, difference)
    return largest


if __name__ == "__main__":
    if len(sys.argv) == 2:
        bits(sys.argv[1])
    else:
        sys.exit(apart(*sys.argv[1:]) >= 1e-12)
