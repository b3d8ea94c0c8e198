"""Scenes: a bearing, or a shaft with its bearings, its loads and what is simulated."""

import json
import os
import shutil
import sys
from dataclasses import dataclass
from html import escape
from pathlib import Path

from . import _native
from ._toml import flat, to_toml


class Scene:
    """A scene: a bearing, or a shaft with its bearings, its loads and what is simulated, as a scene file describes them. It does not
    change; `with_` gives another one.

    Raises ValueError where a key or value is wrong, with the key, the value and the allowed range.
    """

    def __init__(self, native):
        self._native = native

    @classmethod
    def load(cls, path):
        """Reads a scene file. Raises OSError if it cannot be read."""
        return cls(_native.Scene.load(path))

    @classmethod
    def of(cls, scene):
        """A scene as it is, or that of a file, by its path: what functions take that need a scene."""
        return scene if isinstance(scene, cls) else cls.load(Path(scene))

    @classmethod
    def parse(cls, text):
        """Reads a scene from its text in TOML."""
        return cls(_native.Scene.parse(text))

    def with_(self, settings=None, **sections):
        """The scene with some keys changed, one after another.

        Keys are those of the scene file, `{"load.x.force": "2 kN"}`, or sections, `load={"x": {"force": 2000.0}}`. Values are numbers
        in SI, texts with a unit, lists for tables over time. None takes a key or a section out.
        """
        changes = [*flat(settings or {}), *flat(sections)]
        texts = [(key, "" if value is None else to_toml(value)) for key, value in changes]
        return Scene(self._native.edited(texts))

    @property
    def source(self):
        """Its text in TOML."""
        return self._native.source

    @property
    def title(self):
        """Its title."""
        return self._native.title

    @property
    def bearings(self):
        """Names of the bearings of a shaft; none of a bearing alone."""
        return [name for name in self._native.bearings if name]

    def notes(self):
        """What its reader should know: defaults that were taken, values beyond any bearing."""
        return self._native.notes()

    def describe(self, name="bearing"):
        """The model description of its package, XML."""
        return self._native.describe(name)

    def __repr__(self):
        return f"Scene({self.title!r})"

    def _repr_html_(self):
        return f"<b>{escape(self.title)}</b><pre>{escape(self.source)}</pre>"

    def __reduce__(self):
        return Scene.parse, (self.source,)


def effects(scene):
    """Which effects of a scene are on, and which that are off would matter: a dictionary with `settings` by effect and
    `estimates`, a list with `subject`, `standing`, `matters`, `value`, `threshold`, `unit`, `sentence` and what to `write`. Of a shaft one
    of each bearing, by its name."""
    return json.loads(Scene.of(scene)._native.effects())


def cage(scene, jobs=None):
    """What the cage of a scene does when it is pushed: a list with a dictionary for each bearing that has a cage, with `verdict` ("stable",
    "whirls" or "rattles"), its `sentence`, and `pushes`, a list with `motion`, `whirl_ratio`, `pocket_load`, `land_load`, `share` of the
    losses, the `way` of its centre over its play, and others. `jobs` runs at a time, as many as there are cores if not given.

    Raises RuntimeError if there is no cage."""
    return json.loads(Scene.of(scene)._native.cage(jobs))


@dataclass(frozen=True)
class Checked:
    """A file that was looked at."""

    kind: str
    """What it is: the scene of a bearing, a machine, a sweep, a system of packages, and so on."""
    lines: list
    """What it would run, notes on unusual numbers, the time that it would take; errors begin with "error"."""
    good: bool
    """Can it be read, and does its run not stop?"""

    def __str__(self):
        return "\n".join([self.kind, *(f"  {line}" for line in self.lines)])


def check(path):
    """What a file is, and what it would run: a `Checked`, as `roulement check` prints it. A file that is refused raises nothing."""
    kind, lines, good = _native.check(Path(path))
    return Checked(kind, lines, good)


def find_libraries():
    """The shared libraries of packages: those of the environment variable ROULEMENT_LIBRARY (separated as in PATH), those of this package,
    or that which was built together with the program `roulement`. Raises OSError if it is not there or of another build."""
    named = os.environ.get("ROULEMENT_LIBRARY")
    if named:
        return [Path(library) for library in named.split(os.pathsep)]
    # Of as many platforms as the package was built with; what each is, its contents tell. The own one is first, as the program packs them.
    own = {"win32": "roulement.dll", "darwin": "libroulement.dylib"}.get(sys.platform, "libroulement.so")
    found = [path for path in (Path(__file__).parent / "library").glob("*roulement*") if path.suffix in (".so", ".dll", ".dylib")]
    found.sort(key=lambda path: (path.name != own, path.name))
    program = os.environ.get("ROULEMENT_BIN") or shutil.which("roulement")
    if not found and program:
        found = [_native.library_beside(Path(program).resolve())]
    if not found:
        raise FileNotFoundError(
            "the shared library of packages is not there, as this package was built without it: build it by `cargo build --release`, then "
            "name it by `library=` or by the environment variable ROULEMENT_LIBRARY"
        )
    return found


def package(scene, path, library=None, name=None, columns=(), fmi=2):
    """Writes the package of a scene, of FMI 2.0 or, with `fmi=3`, of FMI 3.0: a bearing or a shaft with its bearings; returns its path.

    `library` is the shared library, or a list with one for each platform, that of this package if not given (`find_libraries`); `name`
    that of the model, of the file if not given; `columns` are the outputs that the package has, `*` stands for any characters in their
    names, all if not given.
    Raises OSError if a library is missing or of another platform, ValueError for another `fmi`.
    """
    if library is None:
        library = find_libraries()
    elif isinstance(library, (str, os.PathLike)):
        library = [library]
    _native.package(Scene.of(scene)._native, Path(path), [Path(of) for of in library], name or Path(path).stem, list(columns), fmi)
    return Path(path)
