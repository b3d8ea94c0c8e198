"""Builds the wheel: maturin's backend, with the shared library of FMI packages put beside the Python files.

The library is that which cargo builds together with the program, as the program packs it; or the one that ROULEMENT_LIBRARY names, or
several of them for packages of several platforms, separated as in PATH.
"""

import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import maturin
from maturin import (  # noqa: F401
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_wheel,
)

HERE = Path(__file__).resolve().parent
NAME = {"win32": "roulement.dll", "darwin": "libroulement.dylib"}.get(sys.platform, "libroulement.so")


def _profile():
    """Cargo's profile that maturin is told to build with; `release` if it is not told."""
    arguments = shlex.split(os.environ.get("MATURIN_PEP517_ARGS", ""))
    return arguments[arguments.index("--profile") + 1] if "--profile" in arguments else "release"


def _packed():
    """Bytes of the library as packages carry it. It is built as for the program, so that the extension is linked from the same build."""
    profile = _profile()
    target = HERE.parent / os.environ.get("CARGO_TARGET_DIR", "target")
    # Maturin's cargo, which runs in another folder, takes the same.
    os.environ["CARGO_TARGET_DIR"] = str(target)
    subprocess.run(["cargo", "build", "--locked", "--profile", profile], cwd=HERE.parent, check=True)
    program = target / {"dev": "debug"}.get(profile, profile) / "roulement"
    with tempfile.TemporaryDirectory() as scratch:
        scene, package = Path(scratch, "scene.toml"), Path(scratch, "package.fmu")
        for command in (["bearing", "6205", "-o", scene], ["fmu", scene, "-o", package]):
            subprocess.run([program, *command], check=True, stdout=subprocess.DEVNULL)
        with zipfile.ZipFile(package) as archive:
            (library,) = (name for name in archive.namelist() if name.startswith("binaries/"))
            return archive.read(library)


def put_library():
    """Puts the library, or libraries, where `roulement.package` finds them."""
    folder = HERE / "python" / "roulement" / "library"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    named = os.environ.get("ROULEMENT_LIBRARY")
    if named:
        for library in named.split(os.pathsep):
            shutil.copy(library, folder)
    elif platform.machine() in ("x86_64", "AMD64"):
        # Packages know no other machine.
        (folder / NAME).write_bytes(_packed())


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)
