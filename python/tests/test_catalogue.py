"""Catalogue bearings from Python: the scenes of the command line."""

import pytest
import roulement
from conftest import program
from roulement import catalogue


def test_scenes_are_those_of_the_command_line(tmp_path):
    program("bearing", "6205", "C3", "-o", tmp_path / "bearing.toml")
    scene = catalogue.bearing("6205 C3")
    assert scene.source == (tmp_path / "bearing.toml").read_text()
    assert "ISO 5753-1" in scene.source and scene.title.startswith("6205 C3")
    program("bearing", "7206", "B", "--candidate", "2", "--clearance", "CN", "-o", tmp_path / "no.toml", check=False)
    assert not (tmp_path / "no.toml").exists()
    assert roulement.equilibrium(scene).balls.inner_load.max() > 0


def test_numbers_with_units_stand_beside_names_or_alone():
    first = catalogue.candidates("6206")[0]
    assert (first["balls"], first["ball_diameter"]) == (9, 9.525e-3)
    assert abs(first["dynamic_error"]) < 0.01 and abs(first["static_error"]) < 0.01
    numbers = {"bore": "30 mm", "outside": 0.062, "width": 0.016, "dynamic_load_rating": "19.5 kN", "static_load_rating": 11300.0}
    assert catalogue.candidates(**numbers) == catalogue.candidates("6206")
    assert catalogue.bearing("6206", static_load_rating="11 kN").source != catalogue.bearing("6206").source
    assert len(catalogue.names()) == 608 and "7206 B" in catalogue.names()


def test_errors_have_the_texts_of_the_program():
    with pytest.raises(ValueError, match="6299 is not in the table"):
        catalogue.bearing("6299")
    with pytest.raises(ValueError, match=r"candidate = 99 is out of range: allowed is \[1, 12\]"):
        catalogue.bearing("6205", candidate=99)
    with pytest.raises(TypeError, match="boer is none of bore"):
        catalogue.bearing("6205", boer=1)
