"""The shaft inside one package against the same shaft coupled outside (docs/coupling.md, docs/shaft.md): the claim, and what is written of it."""

import re
import sys

import pytest
from conftest import ROOT, ROULEMENT

sys.path.insert(0, str(ROOT / "scripts"))
import inside_outside  # noqa: E402

RESULTS = inside_outside.read()
FILE, MASTER, LEAPFROG = "inside, mesh in the file", "inside, mesh from the master", "leapfrog"


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    inside_outside.PROGRAM = ROULEMENT
    return inside_outside.Packages(tmp_path_factory.mktemp("inside"))


@pytest.fixture(scope="module")
def exact(packages):
    return inside_outside.reference(packages)


def settles(packages, way, step):
    """Does the vibration after a radial force die down?"""
    simulation = packages.start(way, "kick")
    first, last = inside_outside.settles(simulation, step)
    simulation.close()
    return last < first


def error(packages, exact, way, step):
    """Error of the radial forces [%]."""
    simulation = packages.start(way, "mesh")
    rows, _ = inside_outside.run(simulation, step, inside_outside.DURATION, simulation.forces)
    simulation.close()
    return inside_outside.error(rows, step, exact)


def test_inside_1_ms_is_stable_where_leapfrog_is_not_at_a_tenth_of_it(packages):
    assert settles(packages, FILE, 1000) and settles(packages, MASTER, 1000)
    assert settles(packages, LEAPFROG, 50) and not settles(packages, LEAPFROG, 100)


@pytest.mark.parametrize("way, step", [(FILE, 1000), (FILE, 20), (MASTER, 20), (LEAPFROG, 20), (LEAPFROG, 50)])
def test_errors_are_those_that_are_written(packages, exact, way, step):
    # Errors of some 0.01 % are those of steps inside, which follow the last bits.
    assert error(packages, exact, way, step) == pytest.approx(float(RESULTS[way, step]["error [%]"]), rel=0.1, abs=0.03)


def test_inside_is_more_accurate_at_1_ms_than_leapfrog_at_20_us(packages, exact):
    assert error(packages, exact, FILE, 1000) < 0.2 < error(packages, exact, LEAPFROG, 20)


def test_both_are_the_same_system(packages, exact):
    # Leapfrog with steps of 10 us is 0.2 % away; its error falls with the square of the step.
    assert error(packages, exact, LEAPFROG, 5) < 0.1
    assert float(RESULTS["leapfrog, fine", inside_outside.FINE]["error [%]"]) < 0.02


@pytest.mark.parametrize("document", inside_outside.PARTS)
def test_documents_have_what_the_results_say(document):
    name, part = inside_outside.PARTS[document]
    written = (ROOT / "docs" / document).read_text().split(f"<!-- begin {name} -->")[1].split("<!-- end -->")[0]
    assert written.strip() == part(RESULTS), f"scripts/inside_outside.py --keep renews docs/{document}"


def test_the_figure_is_that_of_the_results(tmp_path):
    number = re.compile(r"-?\d+(?:\.\d+)?")
    inside_outside.picture(RESULTS, tmp_path / "drawn.svg")
    # Names of clip paths are digests of all digits.
    texts = (path.read_text() for path in (inside_outside.FIGURE, tmp_path / "drawn.svg"))
    old, new = (re.sub(r'(#|id=")p[0-9a-f]{9,}', r"\1", text) for text in texts)
    assert number.sub("", old) == number.sub("", new)
    # Half a point: fonts differ in the last digits.
    assert max(abs(float(a) - float(b)) for a, b in zip(number.findall(old), number.findall(new))) < 0.5
