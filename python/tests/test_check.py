"""Files that are looked at: as the command line says it."""

import roulement
from conftest import ROOT, SHELF, program


def test_files_are_told_as_the_command_line_tells_them(tmp_path):
    sweep = ROOT / "examples" / "sweeps" / "misalignment.toml"
    found = roulement.check(sweep)
    assert found.good and found.kind == "a sweep: cases of a scene" and "cases over" in found.lines[0]
    wrong = tmp_path / "wrong.toml"
    wrong.write_text((ROOT / "scenes" / "thrust.toml").read_text().replace("balls = 10", "bals = 10"))
    refused = roulement.check(str(wrong))
    assert not refused.good and any("did you mean balls?" in line for line in refused.lines)
    assert program("check", wrong, check=False).stdout == f"{wrong}: {refused}\n"


def test_a_shelf_of_ones_own_comes_before_the_table(tmp_path):
    shelf = tmp_path / "catalogue.toml"
    shelf.write_text(SHELF)
    own = roulement.catalogue.bearing("6205", shelf=shelf)
    assert 'ball_diameter = "7.9 mm"' in own.source and "7.9375" in roulement.catalogue.bearing("6205").source
    assert len(roulement.catalogue.candidates("6205", shelf=shelf)) == 1
    assert roulement.check(shelf).kind.startswith("a shelf of bearings") and roulement.check(shelf).lines == ["1 bearings: 6205"]
