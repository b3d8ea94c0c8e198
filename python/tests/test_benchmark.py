"""The public benchmark: its questions are made from the reference data, our answers are those of the program, and the runner finds what is wrong."""

import csv
import filecmp
import subprocess
import sys

import pytest
from conftest import PROGRAM, ROOT

FOLDER = ROOT / "benchmark"
sys.path.insert(0, str(FOLDER))

import answer  # noqa: E402
import check  # noqa: E402
import make  # noqa: E402


def ran(*arguments):
    """The runner as its users call it."""
    return subprocess.run([sys.executable, FOLDER / "check.py", *map(str, arguments)], capture_output=True, text=True)


def altered(tmp_path, change):
    """Our answers with changes: id to text of the value, or nothing to leave the row away."""
    with open(FOLDER / "answers" / "roulement.csv", newline="") as file:
        rows = {row["id"]: row["value"] for row in csv.DictReader(file)}
    assert set(change) <= set(rows) | {"unknown"}
    path = tmp_path / "answers.csv"
    rows |= change
    path.write_text("\n".join(["id,value", *(f"{key},{value}" for key, value in rows.items() if value is not None)]) + "\n")
    return path


def test_the_questions_are_those_of_the_reference_data(tmp_path):
    make.main(tmp_path)
    made = sorted(path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file())
    assert len(made) > 50
    assert {path.name for path in (tmp_path / "scenes").iterdir()} == {path.name for path in (FOLDER / "scenes").iterdir()}
    stale = [path for path in made if not filecmp.cmp(tmp_path / path, FOLDER / path, shallow=False)]
    assert not stale, f"benchmark/make.py renews {stale}"
    # Each has a value, a tolerance that can be missed, and says where it is from.
    known = check.questions()
    assert len(known) == 503 and all(float(row["tolerance"]) > 0 and row["source"] for row in known.values())
    assert all((FOLDER / row["file"]).is_file() for row in known.values())


def test_independent_data_the_published_torques_are_those_of_the_data():
    """SKF's model is written here once more: with the friction of a bearing that starts it gives the numbers that came with the data."""
    with open(ROOT / "tests" / "data" / "effects" / "skf_6206.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        loads = [float(row[key]) for key in ("Fr_N", "Fa_N", "speed_rpm", "viscosity_mm2_s")]
        found = make.skf("6206", *loads, 0.15)
        assert found == pytest.approx([float(row["M_rr_Nmm"]), float(row["M_sl_Nmm"])], rel=1e-9)
    assert len(rows) == 5


def test_our_answers_are_those_of_the_program():
    """Of two families all, of runs those that are quick."""
    known = check.questions()
    ours = check.answers(FOLDER / "answers" / "roulement.csv", known)
    assert set(ours) == set(known)
    found = answer.answers(str(PROGRAM), {"equilibria", "contacts"})
    for name, file in (("6206-1500N-0N-3000rpm-19.9mm2s.torque", "run"), ("turning-300--120rpm.cage_speed", "run"), ("stop-and-reverse.energy", "run")):
        (found[name],) = answer.run(str(PROGRAM), known[name]["file"], [known[name]["quantity"]])
    assert len(found) == 476
    # Another processor may round otherwise: far below what decides.
    far = {name: (value, ours[name]) for name, value in found.items() if abs(value - ours[name]) > 0.01 * float(known[name]["tolerance"]) + 1e-6 * abs(value)}
    assert not far, f"benchmark/answer.py renews {far}"
    by_table = answer.contacts(str(PROGRAM), False)
    written = check.answers(FOLDER / "answers" / "roulement-default-law.csv", known)
    assert by_table == pytest.approx(written, abs=1e-5)


def test_the_runner_gives_verdicts_on_our_answers_as_the_document_has_them(tmp_path):
    ended = ran(FOLDER / "answers" / "roulement.csv", "-o", tmp_path / "verdicts.csv")
    # Three torques are far from SKF's model, and nothing else is wrong.
    assert ended.returncode == 1 and "wrong: 6206-500N-0N-12000rpm-15mm2s.torque" in ended.stdout, ended.stdout + ended.stderr
    with open(tmp_path / "verdicts.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 503 and {row["family"] for row in rows if row["verdict"] == "wrong"} == {"torque"}
    assert [row["verdict"] for row in rows].count("wrong") == 3
    for family in ("equilibria", "contacts", "hard"):
        ended = ran(FOLDER / "answers" / "roulement.csv", "--family", family)
        assert ended.returncode == 0 and " 0 wrong" in ended.stdout, ended.stdout
    written = answer.DOCUMENT.read_text().split(answer.BEGIN)[1].split(answer.END)[0]
    assert written == answer.table(), "benchmark/answer.py renews docs/benchmark.md"


def test_answers_of_exudyn_are_those_that_it_can_be_asked():
    known = check.questions()
    theirs = check.answers(FOLDER / "answers" / "exudyn.csv", known)
    assert {(known[name]["family"], known[name]["quantity"] == "cage_speed") for name in theirs} == {("equilibria", False), ("hard", True), ("hard", False)}
    counts = check.counted(check.verdicts(theirs, known))
    assert [(counts[family]["right"], counts[family]["wrong"]) for family in ("equilibria", "hard")] == [(157, 0), (5, 0)]
    # They are its own: to the last digit they differ from ours nearly everywhere.
    ours = check.answers(FOLDER / "answers" / "roulement.csv", known)
    assert sum(theirs[name] != ours[name] for name in theirs) > 120
    script = (FOLDER / "exudyn_answers.py").read_text()
    assert "import roulement" not in script and "subprocess" not in script


@pytest.mark.parametrize("value", ["358", "nan", "-357", "inf", "0"])
def test_a_wrong_answer_fails(tmp_path, value):
    name = "P-01.largest_inner_load"
    # Right is 387.33 N, within 1 %.
    ended = ran(altered(tmp_path, {name: value}), "--family", "equilibria")
    assert ended.returncode == 1 and f"wrong: {name}" in ended.stdout and "172 right,   1 wrong" in ended.stdout, ended.stdout
    assert ran(altered(tmp_path, {name: "390"}), "--family", "equilibria").returncode == 0


def test_what_is_not_answered_is_not_wrong_and_what_cannot_be_read_is_told(tmp_path):
    for left in ("", None):
        ended = ran(altered(tmp_path, {"P-01.largest_inner_load": left}), "--family", "equilibria")
        assert ended.returncode == 0 and "172 right,   0 wrong,   1 not answered" in ended.stdout, ended.stdout
    refused = {
        "is no number": altered(tmp_path, {"P-01.largest_inner_load": "many"}).read_text(),
        "there is no question unknown": altered(tmp_path, {"unknown": "1"}).read_text(),
        "is answered twice": "id,value\nP-01.cage_speed,1\nP-01.cage_speed,1\n".replace("P-01.cage_speed", "P-01.largest_inner_load"),
        "columns id and value": "name,value\na,1\n",
    }
    for words, text in refused.items():
        path = tmp_path / "bad.csv"
        path.write_text(text)
        ended = ran(path)
        assert ended.returncode == 2 and words in ended.stderr and "Traceback" not in ended.stderr, ended.stderr
    assert ran(tmp_path / "nowhere.csv").returncode == 2
    assert ran(FOLDER / "answers" / "roulement.csv", "--family", "none").returncode == 2
