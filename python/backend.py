"""Builds the wheel: maturin's backend, with the program and the shared library of FMI packages put beside the Python files; and the source
distribution, which has the sources of all three.

The library is that which cargo builds together with the program, as the program packs it; or the one that ROULEMENT_LIBRARY names, or
several of them for packages of several platforms, separated as in PATH, beside the program that ROULEMENT_PROGRAM names.
"""

import io
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

import maturin
from maturin import (  # noqa: F401
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_wheel,
)

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
NAME = {"win32": "roulement.dll", "darwin": "libroulement.dylib"}.get(sys.platform, "libroulement.so")
PROGRAM = "roulement.exe" if sys.platform == "win32" else "roulement"
# What the source distribution has: of the folders all that git knows of, or all where there is no git.
SOURCES = ["Cargo.toml", "Cargo.lock", "LICENSE", "README.md", "build.rs", "assets", "benches", "cli", "docs/scene.md",
           *(f"docs/{kind}.schema.json" for kind in ("machine", "scene", "shelf", "sweep", "system")), "examples", "python", "report/bundle", "scenes", "src", "tests"]


def _profile():
    """Cargo's profile that maturin is told to build with; `release` if it is not told."""
    arguments = shlex.split(os.environ.get("MATURIN_PEP517_ARGS", ""))
    return arguments[arguments.index("--profile") + 1] if "--profile" in arguments else "release"


def _build():
    """Builds the program with its library, as for the command line, so that the extension is linked from the same build; gives the program."""
    profile = _profile()
    target = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
    # Maturin's cargo, which runs in another folder, takes the same.
    os.environ["CARGO_TARGET_DIR"] = str(target)
    subprocess.run(["cargo", "build", "--locked", "--profile", profile], cwd=ROOT, check=True)
    return target / {"dev": "debug"}.get(profile, profile) / PROGRAM


def _packed(program):
    """Bytes of the program's library as packages carry it."""
    with tempfile.TemporaryDirectory() as scratch:
        scene, package = Path(scratch, "scene.toml"), Path(scratch, "package.fmu")
        for command in (["bearing", "6205", "-o", scene], ["fmu", scene, "-o", package]):
            subprocess.run([program, *command], check=True, stdout=subprocess.DEVNULL)
        with zipfile.ZipFile(package) as archive:
            (library,) = (name for name in archive.namelist() if name.startswith("binaries/"))
            return archive.read(library)


def put_library():
    """Puts the program, the library or libraries, and the licences of what both are linked from where the package finds them."""
    folder = HERE / "python" / "roulement" / "library"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    named = os.environ.get("ROULEMENT_LIBRARY")
    if named:
        for library in named.split(os.pathsep):
            shutil.copy(library, folder)
        if os.environ.get("ROULEMENT_PROGRAM"):
            shutil.copy(os.environ["ROULEMENT_PROGRAM"], folder)
    else:
        program = _build()
        shutil.copy(program, folder)
        if platform.machine() in ("x86_64", "AMD64"):
            # Packages know no other machine.
            (folder / NAME).write_bytes(_packed(program))
    for name, licences in {"LICENSE": "LICENSE", "assets/licenses.txt": "licenses.txt", "report/bundle/licenses.txt": "licenses-of-pages.txt"}.items():
        shutil.copy(ROOT / name, folder / licences)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    put_library()
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def _sources():
    """Files of the source distribution, relative to the project."""
    try:
        listed = subprocess.run(["git", "ls-files", "-z", "--", *SOURCES], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        found = [Path(name) for name in listed.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        found = []
    if not found:
        # A source distribution made from one.
        within = (path for source in SOURCES for path in [ROOT / source, *(ROOT / source).rglob("*")])
        found = [path.relative_to(ROOT) for path in within if path.is_file() and not {"__pycache__", "library"} & set(path.parts)]
    return sorted(set(found))


def _at_the_root(text):
    """The project's description as it stands at the root of a source distribution, from that in the folder of the package."""
    for here, there in [
        ('backend-path = ["."]', 'backend-path = ["python"]'),
        ('readme = "README.md"', 'readme = "python/README.md"'),
        ('python-source = "python"', 'manifest-path = "python/Cargo.toml"\npython-source = "python/python"'),
        ('path = "python/roulement/library/*"', 'path = "python/python/roulement/library/*"'),
    ]:
        assert text.count(here) == 1, here
        text = text.replace(here, there)
    return text


def build_sdist(sdist_directory, config_settings=None):
    """The sources of the package and of all that it is built from. Maturin's has the folders of crates alone: the program has parts from all over the project."""
    with tempfile.TemporaryDirectory() as scratch:
        metadata = Path(scratch, maturin.prepare_metadata_for_build_wheel(scratch), "METADATA").read_bytes()
    version = next(line.split(": ", 1)[1] for line in metadata.decode().splitlines() if line.startswith("Version: "))
    description = HERE / "pyproject.toml"
    own = description.read_text() if HERE.name == "python" and description.is_file() else None
    name = f"roulement-{version}"
    archive = Path(sdist_directory, f"{name}.tar.gz")
    root = _at_the_root(own) if own else (ROOT / "pyproject.toml").read_text()
    with tarfile.open(archive, "w:gz", format=tarfile.PAX_FORMAT) as packed:

        def add(path, content, mode=0o644):
            entry = tarfile.TarInfo(f"{name}/{path}")
            entry.size, entry.mode, entry.mtime = len(content), mode, int(os.environ.get("SOURCE_DATE_EPOCH", 0))
            packed.addfile(entry, io.BytesIO(content))

        add("PKG-INFO", metadata)
        add("pyproject.toml", root.encode())
        for path in _sources():
            if path != Path("python/pyproject.toml"):
                file = ROOT / path
                add(path.as_posix(), file.read_bytes(), 0o755 if os.access(file, os.X_OK) else 0o644)
    return archive.name
