"""The program in the package, the version, and the source distribution."""

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
import roulement
from roulement import program

ROOT = Path(__file__).resolve().parents[2]


def test_the_program_of_the_package_is_that_of_the_version():
    for start in ([program.path()], [sys.executable, "-m", "roulement"], [Path(sys.executable).with_name("roulement")]):
        told = subprocess.run([*start, "--version"], capture_output=True, text=True, check=True).stdout
        assert told.startswith(f"roulement {roulement.__version__} ")
    # Its refusals are those of a program.
    refused = subprocess.run([sys.executable, "-m", "roulement", "run", "nothing.toml"], capture_output=True, text=True)
    assert refused.returncode != 0 and "nothing.toml" in refused.stderr


def test_program_and_package_pack_the_same_library(tmp_path):
    scene = ROOT / "scenes" / "thrust.toml"
    subprocess.run([program.path(), "fmu", scene, "-o", tmp_path / "a.fmu", "--all-platforms"], check=True, stdout=subprocess.DEVNULL)
    roulement.package(roulement.Scene.load(scene), tmp_path / "b.fmu", name="a")
    one, other = (zipfile.ZipFile(tmp_path / f"{name}.fmu") for name in "ab")
    assert one.namelist() == other.namelist()
    for name in one.namelist():
        assert one.read(name) == other.read(name), name


def test_the_source_distribution_has_all_that_is_built(tmp_path, monkeypatch):
    maturin = pytest.importorskip("maturin")
    assert maturin
    monkeypatch.chdir(ROOT / "python")
    monkeypatch.syspath_prepend(str(ROOT / "python"))
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=":")
    import backend

    archive = tmp_path / backend.build_sdist(str(tmp_path))
    with tarfile.open(archive) as packed:
        names = {name.split("/", 1)[1] for name in packed.getnames()}
        description = packed.extractfile(f"roulement-{roulement.__version__}/pyproject.toml").read().decode()
    assert {"PKG-INFO", "pyproject.toml", "Cargo.lock", "src/lib.rs", "cli/src/main.rs", "python/src/lib.rs", "python/README.md", "python/python/roulement/__init__.py"} <= names
    assert 'manifest-path = "python/Cargo.toml"' in description and 'backend-path = ["python"]' in description
    # What the sources take into themselves lies in it.
    for source in [name for name in names if name.endswith(".rs") and name.startswith(("src/", "cli/src/", "python/src/"))]:
        text = (ROOT / source).read_text()
        for piece in text.split('include_str!("')[1:] + text.split('include_bytes!("')[1:]:
            taken = ((ROOT / source).parent / piece.split('"')[0]).resolve().relative_to(ROOT)
            assert taken.as_posix() in names, f"{source} takes {taken}"
    assert not any(name.startswith(("target/", "build/")) or "/library/" in name for name in names)
