"""The program `roulement`, which comes with this package beside the library that it packs."""

import os
import subprocess
import sys
from pathlib import Path


def path():
    """Path of the program. Raises FileNotFoundError where this package was built without it."""
    program = Path(__file__).parent / "library" / ("roulement.exe" if os.name == "nt" else "roulement")
    if not program.is_file():
        raise FileNotFoundError("this package was built without the program: build it by `cargo build --release`")
    return program


def main():
    """Is the program from here on, with the arguments of this one."""
    try:
        program = str(path())
    except FileNotFoundError as why:
        sys.exit(f"error: {why}")
    if os.name == "nt":
        sys.exit(subprocess.call([program, *sys.argv[1:]]))
    os.execv(program, ["roulement", *sys.argv[1:]])
