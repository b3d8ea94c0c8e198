"""Schemas for editors, by a validator that is not ours: they take all files of the project, and refuse what the program refuses."""

import json
import tomllib

import jsonschema
import pytest
import roulement
from conftest import ROOT, SHELF, program

# The first words by which `roulement check` tells a kind of file.
KINDS = {
    "bearing": "the scene of a bearing",
    "machine": "a machine",
    "shelf": "a shelf of bearings",
    "sweep": "a sweep",
    "system": "the description of a system",
}


@pytest.fixture(scope="module")
def validators():
    schemas = {kind: json.loads(program("scene", "--schema", kind).stdout) for kind in KINDS}
    assert json.loads(program("scene", "--schema").stdout) == schemas["bearing"]
    for schema in schemas.values():
        jsonschema.Draft7Validator.check_schema(schema)
    return {kind: jsonschema.Draft7Validator(schema) for kind, schema in schemas.items()}


def kind_of(path):
    found = roulement.check(path).kind
    return next(kind for kind, words in KINDS.items() if found.startswith(words))


def test_independent_validator_takes_all_files_of_the_project(validators, tmp_path):
    shelf = tmp_path / "catalogue.toml"
    shelf.write_text(SHELF)
    files = [path for folder in ("scenes", "examples") for path in sorted((ROOT / folder).rglob("*.toml"))]
    seen = dict.fromkeys(KINDS, 0)
    for path in [*files, shelf]:
        kind = kind_of(path)
        faults = [f"{path}: {list(fault.absolute_path)} {fault.message[:200]}" for fault in validators[kind].iter_errors(tomllib.loads(path.read_text()))]
        assert not faults, "\n".join(faults)
        seen[kind] += 1
    assert all(seen.values()) and seen["bearing"] > 40, seen


@pytest.mark.parametrize(
    "kind, file, right, wrong",
    [
        ("bearing", "scenes/thrust.toml", "balls = 10", "bals = 10"),
        ("bearing", "scenes/effects/soft_housing.toml", "damping = [", "damping = true\nx = ["),
        ("machine", "examples/gearbox/three_stage.toml", "position =", "positon ="),
        ("machine", "examples/gearbox/shaft.toml", '"-x"', '"-y"'),
        ("shelf", None, "outside", "outer"),
        ("sweep", "examples/sweeps/misalignment.toml", "scene =", "scenes ="),
        ("system", "examples/gearbox/system.toml", "stop =", "end ="),
    ],
)
def test_what_the_program_refuses_its_schema_refuses(kind, file, right, wrong, validators, tmp_path):
    text = (ROOT / file).read_text() if file else SHELF
    assert right in text and validators[kind].is_valid(tomllib.loads(text))
    altered = text.replace(right, wrong, 1)
    assert not validators[kind].is_valid(tomllib.loads(altered))
    path = tmp_path / (f"{kind}.toml" if file else "catalogue.toml")
    path.write_text(altered)
    assert not roulement.check(path).good
