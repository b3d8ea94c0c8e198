"""Builds the wheel: maturin's backend, with the shared library of FMI packages put beside the Python files.

The library is that which cargo makes on its way to the extension, stripped; or the one that ROULEMENT_LIBRARY names, or several of
them for packages of several platforms, separated as in PATH.
"""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import maturin
from maturin import (  # noqa: F401
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_wheel,
)

HERE = Path(__file__).parent
NAME = {"win32": "roulement.dll", "darwin": "libroulement.dylib"}.get(sys.platform, "libroulement.so")


def _profile():
    """Cargo's profile that maturin is told to build with; `release` if it is not told."""
    arguments = shlex.split(os.environ.get("MATURIN_PEP517_ARGS", ""))
    return arguments[arguments.index("--profile") + 1] if "--profile" in arguments else "release"


def _built():
    """The library, as a part of the same build as the extension."""
    profile = _profile()
    command = ["cargo", "build", "--locked", "--profile", profile, "--manifest-path", HERE / "Cargo.toml", "--features", "pyo3/extension-module"]
    subprocess.run(list(map(str, command)), check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parent / "target"))
    return target / {"dev": "debug"}.get(profile, profile) / "deps" / NAME


def put_library():
    """Copies the library, or libraries, to where `roulement.package` finds them."""
    folder = HERE / "python" / "roulement" / "library"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    named = os.environ.get("ROULEMENT_LIBRARY")
    for library in map(Path, named.split(os.pathsep)) if named else [_built()]:
        place = Path(shutil.copy(library, folder))
        strip = shutil.which("strip")
        if not named and strip:
            # Debug data are five sixths of it.
            subprocess.run([strip, "-x" if sys.platform == "darwin" else "--strip-unneeded", str(place)], check=True)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)
