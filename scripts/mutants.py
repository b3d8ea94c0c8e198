"""Mutation testing by schemata: a seeded sample of expressions is written twice, as it is and with a fault, and an
environment variable says which fault is on. One build serves all faults; only tests that reach a fault run against it,
the quick and strong ones first, until one fails.

Faults that were judged equal in effect, or of performance alone, stand with their reasons in scripts/mutants-accepted.csv;
faults planted by hand (option --planted) in scripts/mutants-planted.csv.
"""

import argparse
import concurrent.futures
import csv
import hashlib
import json
import os
import random
import re
import shutil
import subprocess
import sys
import threading
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

import tree_sitter_rust
from tree_sitter import Language, Parser

# What is mutated if nothing is named: edit here when files move.
DEFAULT = ["src/contact", "src/kalker", "src/forces.rs", "src/dynamics", "src/equilibrium", "src/simulation/outputs.rs"]
# Tests that measure clocks or run long without looking at forces.
SKIPPED = re.compile(r"^studies::cost(_reference)?::|^leaks::|^scene::hostile_files::|^roulement_cli::cost::")
ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "scripts/mutants-accepted.csv"
PLANTED = ROOT / "scripts/mutants-planted.csv"

RUNTIME = """//! Which fault is on.
#![allow(missing_docs)]
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

const RECORDING: u32 = u32::MAX - 1;
const UNREAD: u32 = u32::MAX;
static ON: AtomicU32 = AtomicU32::new(UNREAD);
static SEEN: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

#[inline(always)]
pub fn active(id: u32) -> bool {
    let on = ON.load(Ordering::Relaxed);
    if on < RECORDING { on == id } else { slow(id) }
}

#[cold]
#[inline(never)]
fn slow(id: u32) -> bool {
    if ON.load(Ordering::Relaxed) == RECORDING && SEEN[id as usize].load(Ordering::Relaxed) {
        return false;
    }
    let record = std::env::var("MUTANT_RECORD").ok();
    if ON.load(Ordering::Relaxed) == UNREAD {
        let on = std::env::var("MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        ON.store(if record.is_some() { RECORDING } else { on }, Ordering::Relaxed);
    }
    if let Some(path) = record {
        if !SEEN[id as usize].swap(true, Ordering::Relaxed) {
            if let Ok(mut file) = std::fs::OpenOptions::new().create(true).append(true).open(path) {
                let _ = file.write_all(format!("{id}\\n").as_bytes());
            }
        }
        return false;
    }
    ON.load(Ordering::Relaxed) == id
}
"""

SWAPPED = {"+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "==",
           "&&": "||", "||": "&&"}
CALLS = {"min": "max", "max": "min", "sin": "cos", "cos": "sin"}
# Nodes inside which nothing is an expression of its own right, or must be constant.
CLOSED = {"attribute_item", "inner_attribute_item", "const_item", "static_item", "macro_invocation", "macro_definition",
          "use_declaration", "type_arguments", "type_parameters", "array_type", "where_clause", "const_block",
          "match_pattern", "let_chain", "visibility_modifier", "enum_item", "struct_item"}


@dataclass
class Mutant:
    path: str
    start: int
    end: int
    line: int
    old: str
    new: str
    statement: bool = False
    note: str = ""
    id: int = 0
    reached_by: list = field(default_factory=list)
    verdict: str = ""
    killer: str = ""

    def text(self):
        return f"{squeeze(self.old)} -> {squeeze(self.new)}"


def squeeze(text):
    return re.sub(r"\s+", " ", text).strip()


def files_of(names):
    for name in names:
        path = ROOT / name
        if path.is_dir():
            yield from sorted(p.relative_to(ROOT) for p in path.rglob("*.rs"))
        elif path.is_file():
            yield path.relative_to(ROOT)
        else:
            sys.exit(f"error: {name} is neither a file nor a folder")


class Finder:
    """All faults of one file."""

    def __init__(self, path, parser):
        self.path, self.source = str(path), (ROOT / path).read_bytes()
        self.mutants = []
        self.walk(parser.parse(self.source).root_node)

    def text(self, node):
        return self.source[node.start_byte : node.end_byte].decode()

    def add(self, node, new, statement=False):
        old, line = self.text(node), node.start_point[0] + 1
        self.mutants.append(Mutant(self.path, node.start_byte, node.end_byte, line, old, new, statement))

    def walk(self, node):
        skip_next = False
        for child in node.children:
            if child.type == "attribute_item":
                if "cfg(test)" in self.text(child) or "#[test]" in self.text(child):
                    skip_next = True
                continue
            if skip_next and child.type not in ("line_comment", "block_comment"):
                skip_next = False
                continue
            if child.type in CLOSED or child.type.endswith("_pattern"):
                continue
            if child.type == "function_item" and any(
                c.type == "function_modifiers" and "const" in self.text(c) for c in child.children
            ):
                continue
            self.visit(child)
            if child.type == "array_expression" and child.child_by_field_name("length"):
                length = child.child_by_field_name("length")
                for part in child.named_children:
                    if part.id != length.id:
                        self.visit(part)
                        self.walk(part)
                continue
            self.walk(child)

    def visit(self, node):
        parent = node.parent
        if parent is not None and parent.type == "field_expression" and node.type == "integer_literal":
            return
        kind = node.type
        if kind == "binary_expression":
            sides = node.child_by_field_name("left"), node.child_by_field_name("right")
            operator = node.child_by_field_name("operator").type
            if operator in SWAPPED and "let " not in self.text(node):
                left, right = map(self.text, sides)
                self.add(node, f"{left} {SWAPPED[operator]} {right}")
        elif kind == "unary_expression" and self.text(node).startswith("-"):
            inner = node.named_children[-1]
            if inner.type not in ("integer_literal", "float_literal"):
                self.add(node, self.text(inner))
        elif kind == "compound_assignment_expr" and parent.type == "expression_statement":
            operator = node.child_by_field_name("operator").type
            if operator in ("+=", "-="):
                self.add(node, "()", statement=True)
        elif kind == "float_literal":
            number = re.match(r"[0-9_]*\.?[0-9_]*(?:[eE][+-]?[0-9_]+)?", self.text(node)).group()
            value = float(number.replace("_", ""))
            suffix = self.text(node)[len(number) :]
            self.add(node, (repr(1.1 * value) if value else "0.1") + suffix)
        elif kind == "integer_literal" and re.fullmatch(r"[0-9_]+", self.text(node)):
            self.add(node, str(int(self.text(node).replace("_", "")) + 1))
        elif kind == "call_expression":
            function = node.child_by_field_name("function")
            if function.type == "field_expression":
                name = function.child_by_field_name("field")
                if self.text(name) in CALLS:
                    a, b = name.start_byte - node.start_byte, name.end_byte - node.start_byte
                    whole = self.source[node.start_byte : node.end_byte]
                    self.add(node, (whole[:a] + CALLS[self.text(name)].encode() + whole[b:]).decode())


def planted_mutants():
    """Faults by hand: the only place of a text in a file, and what stands there instead."""
    for row in csv.DictReader(PLANTED.open()):
        source = (ROOT / row["file"]).read_text()
        if source.count(row["old"]) != 1:
            sys.exit(f"error: {row['old']!r} is not in {row['file']} exactly once")
        start = source.encode().index(row["old"].encode())
        line = source[: source.index(row["old"])].count("\n") + 1
        statement = row["old"].rstrip().endswith(";")
        yield Mutant(row["file"], start, start + len(row["old"].encode()), line, row["old"], row["new"], statement,
                     row["fault"])


def choose(mutants, count, seed):
    """A sample spread over the files by their number of expressions, as it comes."""
    return sorted(random.Random(seed).sample(mutants, min(count, len(mutants))), key=lambda m: (m.path, m.start))


def rewrite(source, mutants):
    """The file with all of its faults, each marked by comments."""

    def render(start, end, inside):
        out, at = [], start
        while inside:
            outer = max((m for m in inside if m.start == min(m.start for m in inside)), key=lambda m: m.end)
            nested = [m for m in inside if m is not outer and m.start >= outer.start and m.end <= outer.end]
            inside = [m for m in inside if m is not outer and m not in nested]
            out.append(source[at : outer.start])
            original = render(outer.start, outer.end, nested)
            head, tail = f"/*[{outer.id}*/".encode(), f"/*{outer.id}]*/".encode()
            test = f"crate::mutant::active({outer.id})".encode()
            if outer.statement and outer.new == "()":
                out.append(head + b"if !" + test + b" { " + original + b" }" + tail)
            elif outer.statement:
                out.append(head + b"if " + test + b" { " + outer.new.encode() + b" } else { " + original + b" }" + tail)
            else:
                out.append(head + b"(if " + test + b" { " + outer.new.encode() + b" } else { " + original + b" })" + tail)
            at = outer.end
        out.append(source[at:end])
        return b"".join(out)

    return render(0, len(source), list(mutants))


class Workshop:
    """A copy of the checkout with the faults in it, and its test programs."""

    def __init__(self, folder, mutants):
        self.folder, self.checkout = folder, folder / "checkout"
        self.environment = dict(os.environ, CARGO_TARGET_DIR=str(folder / "target"))
        self.environment.pop("MUTANT", None)
        self.checkout.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=ROOT, check=True,
                                capture_output=True).stdout.decode()
        names = {name for name in listed.split("\0") if name and (ROOT / name).is_file()}
        for old in self.checkout.rglob("*"):
            if old.is_file() and str(old.relative_to(self.checkout)) not in names | {"src/mutant.rs"}:
                old.unlink()
        # Files with faults are written once, with them: a build that is there already stays.
        later = {m.path for m in mutants} | {"src/lib.rs"}
        for name in names - later:
            self.put(name, (ROOT / name).read_bytes())

    def put(self, name, content):
        target = self.checkout / name
        if not target.exists() or target.read_bytes() != content:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
            mode = (ROOT / name).stat().st_mode if (ROOT / name).exists() else 0o644
            target.chmod(mode)

    def plant(self, mutants):
        by_file = defaultdict(list)
        for mutant in mutants:
            by_file[mutant.path].append(mutant)
        for path, of_file in by_file.items():
            self.put(path, rewrite((ROOT / path).read_bytes(), of_file))
        lib = (ROOT / "src/lib.rs").read_text()
        self.put("src/lib.rs", (lib + "#[doc(hidden)]\npub mod mutant;\n").encode())
        count = max((m.id for m in mutants), default=0) + 1
        self.put("src/mutant.rs", RUNTIME.replace("COUNT", str(count)).encode())

    def cargo(self, *arguments):
        """JSON messages of cargo."""
        done = subprocess.run(["cargo", *arguments, "--locked", "--release", "--message-format=json"],
                              cwd=self.checkout, env=self.environment, capture_output=True, text=True)
        messages = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        return done.returncode, messages, done.stderr

    def build(self, mutants):
        """Builds; faults that do not compile are left out. Returns those that do."""
        known_file = self.folder / "not-compiling.json"
        known = json.loads(known_file.read_text()) if known_file.exists() else []
        keys = {m.id: f"{m.path} {m.start} {m.old} {m.new}" for m in mutants}
        left = [m for m in mutants if keys[m.id] not in known]
        while True:
            for path in {m.path for m in mutants}:
                if not any(m.path == path for m in left):
                    self.put(path, (ROOT / path).read_bytes())
            self.plant(left)
            code, messages, errors = self.cargo("check", "--lib")
            if code == 0:
                break
            wrong = self.blamed(messages, left)
            if not wrong:
                sys.exit(f"error: the copy does not compile and no fault is to blame:\n{errors[-3000:]}")
            left = [m for m in left if m.id not in wrong]
            known_file.write_text(json.dumps(known := known + [keys[id] for id in wrong]))
            print(f"{len(wrong)} faults do not compile and are left out, {len(left)} left", flush=True)
        code, messages, errors = self.cargo("test", "--no-run", "--lib", "--bins", "--tests")
        if code != 0:
            wrong = self.blamed(messages, left)
            if not wrong:
                sys.exit(f"error: tests do not build:\n{errors[-3000:]}")
            return self.build([m for m in left if m.id not in wrong])
        programs = {}
        for message in messages:
            if message.get("reason") == "compiler-artifact" and message.get("executable") and message["profile"]["test"]:
                kind = message["target"]["kind"][0]
                programs["bin" if kind == "bin" else message["target"]["name"]] = message["executable"]
        self.programs = programs
        return left

    def blamed(self, messages, mutants):
        wrong = set()
        for message in messages:
            inner = message.get("message") or {}
            if message.get("reason") != "compiler-message" or inner.get("level") != "error":
                continue
            spans = sorted(inner["spans"], key=lambda span: not span["is_primary"])
            for span in spans:
                path = self.checkout / span["file_name"]
                if not path.is_file():
                    continue
                at = span["byte_start"]
                text = path.read_bytes()
                around = [m for m in mutants if m.path == span["file_name"]]
                enclosing = []
                for m in around:
                    head, tail = text.find(f"/*[{m.id}*/".encode()), text.find(f"/*{m.id}]*/".encode())
                    if 0 <= head <= at < tail:
                        enclosing.append((tail - head, m.id))
                if enclosing:
                    wrong.add(min(enclosing)[1])
                    break
            else:
                # A fault that leaves the types of what follows open: those of the same line.
                for span in spans:
                    for m in mutants:
                        if m.path == span["file_name"] and abs(m.line - span["line_start"]) <= 3:
                            wrong.add(m.id)
        return wrong

    def tests(self):
        for name, program in sorted(self.programs.items()):
            listed = subprocess.run([program, "--list", "--format", "terse"], cwd=self.checkout, capture_output=True,
                                    text=True, check=True, env=self.environment).stdout
            ignored = subprocess.run([program, "--list", "--format", "terse", "--ignored"], cwd=self.checkout,
                                     capture_output=True, text=True, check=True, env=self.environment).stdout
            for line in listed.splitlines():
                if line.endswith(": test") and line not in ignored.splitlines():
                    yield name, line.removesuffix(": test")

    def run(self, test, timeout=None, **variables):
        """True if it passes, False if not, None if it takes too long; and the time."""
        name, case = test
        begin = time.monotonic()
        process = subprocess.Popen([self.programs[name], "--exact", case], cwd=self.checkout,
                                   env={**self.environment, **variables}, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            passed = process.wait(timeout) == 0
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
            passed = None
        return passed, time.monotonic() - begin


def survey(workshop, mutants, jobs, slowest):
    """Runs all tests without a fault: which pass, how long each takes, and which faults it reaches. What an earlier run with
    the same programs and faults found is not run again; nor are tests that took too long in any earlier run."""
    tests = [test for test in workshop.tests() if not SKIPPED.match("::".join(test))]
    records = workshop.folder / "records"
    shutil.rmtree(records, ignore_errors=True)
    records.mkdir()
    known_file = workshop.folder / "survey.json"
    known = json.loads(known_file.read_text()) if known_file.exists() else {}
    faults = hashlib.sha256("".join(f"{m.id} {m.path} {m.start} {m.new}\n" for m in mutants).encode()).hexdigest()
    programs = {name: hashlib.sha256(Path(path).read_bytes()).hexdigest() for name, path in workshop.programs.items()}
    times, reached, left_out = {}, defaultdict(list), []

    def one(item):
        number, test = item
        mark = [faults, programs[test[0]]]
        before = known.get("::".join(test))
        if before and (before["mark"] == mark or before["seconds"] > slowest):
            return test, before
        record = records / str(number)
        passed, seconds = workshop.run(test, 4.0 * slowest, MUTANT_RECORD=str(record))
        seen = sorted({int(line) for line in record.read_text().split()}) if record.exists() else []
        return test, {"mark": mark, "passed": passed, "seconds": seconds, "seen": seen}

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for test, found in pool.map(one, enumerate(tests)):
            known["::".join(test)] = found
            if not found["passed"] or found["seconds"] > slowest:
                left_out.append((test, "fails without a fault" if found["passed"] is False else "slow"))
                continue
            times[test] = found["seconds"]
            for id in found["seen"]:
                reached[id].append(test)
    for mutant in mutants:
        mutant.reached_by = reached[mutant.id]
    known_file.write_text(json.dumps(known))
    return times, left_out


def accepted_reasons():
    """Reasons by file name, line of source and fault; folders and line numbers may change."""
    if not ACCEPTED.exists():
        return {}
    rows = csv.DictReader(ACCEPTED.open())
    return {(Path(row["file"]).name, row["line"], row["old"], row["new"]): row["reason"] for row in rows}


def accept(mutants):
    """Marks faults that are accepted as equal in effect, or of performance alone."""
    reasons = accepted_reasons()
    for mutant in mutants:
        line = (ROOT / mutant.path).read_text().splitlines()[mutant.line - 1].strip()
        key = (Path(mutant.path).name, line, squeeze(mutant.old), squeeze(mutant.new))
        if key in reasons:
            mutant.verdict, mutant.note = "accepted", reasons[key]


def judge(workshop, mutants, times, jobs, resume):
    """Runs the tests that reach each fault until one fails; `resume`: a fault that was caught stays so, and one that survived
    meets only tests whose programs are new."""
    verdicts_file = workshop.folder / "verdicts.json"
    before = json.loads(verdicts_file.read_text()) if resume and verdicts_file.exists() else {}
    programs = {name: hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16] for name, path in workshop.programs.items()}
    kills, tries, lock = defaultdict(int), defaultdict(int), threading.Lock()

    def promise(test):
        return -(kills[test] + 0.3) / (tries[test] + 1.0) / (times[test] + 0.05)

    def mark(test):
        return f"{'::'.join(test)} {programs[test[0]]}"

    def one(mutant):
        key = f"{mutant.path} {mutant.start} {mutant.old} {mutant.new}"
        if mutant.verdict == "accepted":
            return mutant
        known = before.get(key, {"verdict": "", "killer": "", "passed": []})
        if known["killer"]:
            mutant.verdict, mutant.killer = known["verdict"], known["killer"]
            return mutant
        passed = set(known["passed"])
        waiting = [test for test in mutant.reached_by if mark(test) not in passed]
        mutant.verdict = "survived" if mutant.reached_by else "not reached"
        while waiting:
            with lock:
                test = min(waiting, key=promise)
                tries[test] += 1
            waiting.remove(test)
            outcome, _ = workshop.run(test, 10.0 + 8.0 * times[test], MUTANT=str(mutant.id))
            if not outcome:
                with lock:
                    kills[test] += 1
                mutant.verdict, mutant.killer = "timeout" if outcome is None else "caught", "::".join(test)
                break
            passed.add(mark(test))
        with lock:
            before[key] = {"verdict": mutant.verdict, "killer": mutant.killer, "passed": sorted(passed)}
            verdicts_file.write_text(json.dumps(before))
        return mutant

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done, mutant in enumerate(pool.map(one, mutants), 1):
            print(f"{done}/{len(mutants)} {mutant.verdict:12} {mutant.path}:{mutant.line} {mutant.text()[:90]}"
                  f"  [{mutant.killer}]", flush=True)


def report(path, mutants, left_out, options, seconds):
    folders = defaultdict(lambda: defaultdict(int))
    for mutant in mutants:
        parts = Path(mutant.path).parts
        folder = "/".join(parts[:2])
        for name in (folder, "all"):
            folders[name][mutant.verdict] += 1
    verdicts = ["caught", "timeout", "survived", "not reached", "accepted"]
    lines = ["# Mutation testing", "",
             f"`scripts/mutants REPORT.md {' '.join(options)}`: {len(mutants)} faults that compile, {seconds / 60:.0f} minutes. "
             "A timeout counts as caught; accepted survivors do not count (scripts/mutants-accepted.csv).", "",
             "| folder | " + " | ".join(verdicts) + " | score |", "|---|" + "---|" * (len(verdicts) + 1)]
    for name in sorted(folders, key=lambda name: (name == "all", name)):
        counts = folders[name]
        caught = counts["caught"] + counts["timeout"]
        total = caught + counts["survived"] + counts["not reached"]
        score = f"{100.0 * caught / total:.1f} %" if total else ""
        lines.append(f"| {name} | " + " | ".join(str(counts[v]) for v in verdicts) + f" | {score} |")
    for title, wanted in (("Survivors", ("survived", "not reached")), ("Accepted", ("accepted",))):
        rows = [m for m in mutants if m.verdict in wanted]
        if rows:
            lines += ["", f"## {title}", "", "| place | fault | tests that reach it | |", "|---|---|---|---|"]
            for m in rows:
                text = m.text().replace("|", "\\|")
                lines.append(f"| {m.path}:{m.line} | `{text}` | {len(m.reached_by)} | {m.note} |")
    planted = [m for m in mutants if m.note and m.verdict in ("caught", "timeout")]
    if planted:
        lines += ["", "## Planted by hand", "", "| fault | place | first test that fails |", "|---|---|---|"]
        lines += [f"| {m.note} | {m.path}:{m.line} | `{m.killer}` |" for m in planted]
    if left_out:
        lines += ["", "Tests left out: " + ", ".join(f"`{'::'.join(test)}` ({why})" for test, why in left_out) + "."]
    Path(path).write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(prog="scripts/mutants", description=__doc__)
    parser.add_argument("report", help="markdown file to write")
    parser.add_argument("sources", nargs="*", default=DEFAULT, help=f"folders and files ({' '.join(DEFAULT)})")
    parser.add_argument("--count", type=int, default=200, help="size of the sample (200)")
    parser.add_argument("--seed", type=int, default=1, help="of the sample (1)")
    parser.add_argument("--planted", action="store_true", help="the faults of scripts/mutants-planted.csv as well")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="tests at a time (processors)")
    parser.add_argument("--slowest", type=float, default=60.0, help="[s] longest test that is used (60)")
    parser.add_argument("--scratch", type=Path, default=ROOT / "target/mutants", help="scratch folder (target/mutants)")
    parser.add_argument("--resume", action="store_true",
                        help="faults caught before stay caught: after tests were added, with src unchanged")
    parser.add_argument("--accepted", action="store_true", help="run the tests against accepted faults too")
    parser.add_argument("--list", action="store_true", help="only list the sample")
    options = parser.parse_args()
    begin = time.monotonic()
    rust = Parser(Language(tree_sitter_rust.language()))
    found = [m for path in files_of(options.sources) for m in Finder(path, rust).mutants]
    # A fifth does not compile (types without that operator); what is left over is cut.
    mutants = choose(found, int(options.count * 1.3), options.seed)
    print(f"{len(found)} expressions, {len(mutants)} sampled", flush=True)
    if options.planted:
        mutants += planted_mutants()
    for number, mutant in enumerate(mutants, 1):
        mutant.id = number
    if options.list:
        for mutant in mutants:
            print(f"{mutant.path}:{mutant.line} {mutant.text()}")
        return
    workshop = Workshop(options.scratch, mutants)
    mutants = workshop.build(mutants)
    print(f"built in {time.monotonic() - begin:.0f} s", flush=True)
    sampled, planted = [m for m in mutants if not m.note], [m for m in mutants if m.note]
    mutants = choose(sampled, options.count, options.seed) + planted
    times, left_out = survey(workshop, mutants, options.jobs, options.slowest)
    print(f"{len(times)} tests, {sum(times.values()):.0f} s; {time.monotonic() - begin:.0f} s so far", flush=True)
    if not options.accepted:
        accept(mutants)
    judge(workshop, mutants, times, options.jobs, options.resume)
    if options.accepted:
        accept([m for m in mutants if m.verdict in ("survived", "not reached")])
    given = [a for a in sys.argv[2:] if not a.startswith("/")]
    report(options.report, mutants, left_out, given, time.monotonic() - begin)
    print(Path(options.report).read_text())


if __name__ == "__main__":
    main()
