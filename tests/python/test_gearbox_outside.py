"""The three-stage gearbox as one package against four packages of its shafts with the meshes in a master (docs/gearbox.md): what is stable, and what is written of it."""

import sys

import numpy as np
import pytest
from conftest import ROOT, ROULEMENT

sys.path.insert(0, str(ROOT / "scripts"))
import gearbox_outside  # noqa: E402

RESULTS = gearbox_outside.read()


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """The unit and the master, and the places of the master's forces among those of the unit; torque comes on at 0.2 ms of 1 ms."""
    gearbox_outside.PROGRAM = ROULEMENT
    gearbox_outside.DURATION, gearbox_outside.LOOK = 1e-3, 1e-4
    folder = tmp_path_factory.mktemp("gearbox")
    whole, alone, meshes, forces = gearbox_outside.scenes({}, step_at=2e-4)
    unit = gearbox_outside.Unit(whole, folder, "whole")
    master = gearbox_outside.Master(alone, meshes, forces, folder, gearbox_outside.polar(folder, whole))
    return unit, master, gearbox_outside.order(unit, master)


def test_both_are_the_same_gearbox(both):
    unit, master, order = both
    exact, _ = gearbox_outside.run(unit, 1e-5)
    found, _ = gearbox_outside.run(master, 1e-6)
    size = np.abs(exact[0]).max()
    # They start alike, and go alike as far as a master that is a microsecond late can.
    assert np.abs(found[0] - exact[0, order]).max() < 1e-4 * size
    assert np.abs(found - exact[:, order]).max() < 1e-3 * size
    assert np.abs(exact[-1] - exact[0]).max() > 0.02 * size


def test_inside_half_a_millisecond_is_stable_where_the_master_is_not_at_a_tenth_of_it(both):
    unit, master, _ = both
    assert gearbox_outside.run(unit, 5e-4)[0] is not None
    assert gearbox_outside.run(master, 5e-5)[0] is None


def test_the_document_has_what_the_results_say():
    written = gearbox_outside.DOCUMENT.read_text().split("<!-- begin outside of the gearbox -->")[1].split("<!-- end -->")[0]
    assert written.strip() == gearbox_outside.table(RESULTS), "scripts/gearbox_outside.py --keep renews docs/gearbox.md"
