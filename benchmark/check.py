#!/usr/bin/env python3
"""Verdicts of a program's answers to the questions of this folder. Needs Python 3.9 or newer and nothing else.

Usage: check.py ANSWERS.csv [-o VERDICTS.csv] [--family NAME]

ANSWERS.csv has the columns `id` and `value`, in the unit of the question; other columns are ignored. An empty value says that the program cannot
be asked this. VERDICTS.csv gets a row for each question: what was answered, what is right, how far off that is over the tolerance, and the verdict
(right, wrong, not answered). Code 0: nothing is wrong; 1: something is; 2: the answers cannot be read.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

QUESTIONS = Path(__file__).resolve().parent / "questions.csv"


class Unreadable(Exception):
    """Answers that are none."""


def questions(path=QUESTIONS):
    """All questions by their ids, in order."""
    with open(path, newline="", encoding="utf-8") as file:
        return {row["id"]: row for row in csv.DictReader(file)}


def answers(path, known):
    """Values by id; nothing where a program has no answer."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as why:
        raise Unreadable(f"cannot read {path}: {why}") from why
    if not rows or not {"id", "value"} <= set(rows[0]):
        raise Unreadable(f"{path} has to have the columns id and value, and rows")
    found = {}
    for line, row in enumerate(rows, 2):
        name, text = row["id"], (row["value"] or "").strip()
        if name not in known:
            raise Unreadable(f"{path}, line {line}: there is no question {name}")
        if name in found:
            raise Unreadable(f"{path}, line {line}: {name} is answered twice")
        try:
            found[name] = float(text) if text else None
        except ValueError:
            raise Unreadable(f"{path}, line {line}: {text!r} is no number") from None
    return found


def verdict(question, value):
    """How far off an answer is [tolerances], and what that makes of it."""
    if value is None:
        return None, "not answered"
    off = abs(value - float(question["value"])) / float(question["tolerance"])
    # What is no number is wrong, too.
    return off, "right" if off <= 1.0 else "wrong"


def verdicts(found, asked):
    """A row for each question."""
    rows = []
    for name, question in asked.items():
        value = found.get(name)
        off, said = verdict(question, value)
        shown = {"answer": "" if value is None else repr(value), "off": "" if off is None else f"{off:.3g}", "verdict": said}
        rows.append({**{key: question[key] for key in ("id", "family", "quantity", "unit", "value", "tolerance")}, **shown})
    return rows


def counted(rows):
    """How many verdicts of each kind a family has, and its largest error [tolerances]."""
    table = {}
    for row in rows:
        counts = table.setdefault(row["family"], {"right": 0, "wrong": 0, "not answered": 0, "worst": 0.0})
        counts[row["verdict"]] += 1
        off = float(row["off"] or 0.0)
        counts["worst"] = max(counts["worst"], math.inf if math.isnan(off) else off)
    return table


def main(arguments=None):
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("answers")
    parser.add_argument("-o", "--output", help="table of verdicts")
    parser.add_argument("--family", help="only these questions")
    given = parser.parse_args(arguments)
    known = questions()
    asked = {name: row for name, row in known.items() if given.family in (None, row["family"])}
    try:
        if not asked:
            raise Unreadable(f"there is no family {given.family}")
        rows = verdicts(answers(given.answers, known), asked)
    except Unreadable as why:
        print(f"error: {why}", file=sys.stderr)
        return 2
    if given.output:
        with open(given.output, "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, rows[0], lineterminator="\n")
            table.writeheader()
            table.writerows(rows)
    for family, counts in counted(rows).items():
        print(f"{family:<12} {counts['right']:4} right, {counts['wrong']:3} wrong, {counts['not answered']:3} not answered, worst {counts['worst']:.2g} tolerances")
    wrong = [row for row in rows if row["verdict"] == "wrong"]
    for row in wrong[:20]:
        print(f"wrong: {row['id']} = {row['answer']} {row['unit']}, right is {row['value']} within {row['tolerance']}")
    if len(wrong) > 20:
        print(f"and {len(wrong) - 20} more")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
