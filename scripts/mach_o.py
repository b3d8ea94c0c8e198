#!/usr/bin/env python3
"""What a library, a program or a Python extension for macOS says of itself, read without a Mac: its name, oldest system, needed libraries, names that it
takes from frameworks or leaves to whoever loads it, functions of FMI or of Python that it has, and whether each page has the hash of its signature. Fails where one
has not, where a file for aarch64, of which macOS loads no other, is not signed, where a newer system is wanted than wheels say, where a library is needed
that is not of the system, or where an extension leaves open what Python has not. Lists of names are read as zig writes them.
Usage: mach_o.py FILE ...
"""

import hashlib
import struct
import sys

AARCH64 = 0x0100000C
KINDS = {2: "program", 6: "library", 8: "library"}
# The oldest system that wheels say, macOS 11.0.
SAID = 0xB0000
# Load commands: needed library, own name, folder of libraries, signature, lists of exports (two forms), oldest system.
NEEDED, NAME, FOLDER, SIGNATURE, EXPORTS, LOADING, OLDEST = (0xC, 0x80000018, 0x8000001F), 0xD, 0x8000001C, 0x1D, (0x80000033,), (0x22, 0x80000022), 0x32
# In the place of a library's number: whoever loads the file has the name.
OPEN = -2
# A signature of nobody has one part, the directory of hashes.
DIRECTORY = 0xFADE0C02


def number(data, at):
    """A number of seven bits a byte, and where it ends."""
    value = shift = 0
    while True:
        byte = data[at]
        value, shift, at = value | (byte & 127) << shift, shift + 7, at + 1
        if byte < 128:
            return value, at


def exports(tree, at=0, before=""):
    """Names of a tree of exports."""
    size, at = number(tree, at)
    if size:
        yield before
    at += size
    children, at = tree[at], at + 1
    for _ in range(children):
        end = tree.index(0, at)
        part = tree[at:end].decode()
        child, at = number(tree, end + 1)
        yield from exports(tree, child, before + part)


def wrong_pages(data, signature):
    """How many pages a signature has, and how many of them have another hash."""
    for k in range(struct.unpack_from(">I", signature, 8)[0]):
        part = signature[struct.unpack_from(">2I", signature, 12 + 8 * k)[1] :]
        if struct.unpack_from(">I", part)[0] != DIRECTORY:
            continue
        hashes, _, _, pages, end = struct.unpack_from(">5I", part, 16)
        size, _, _, shift = struct.unpack_from("4B", part, 36)
        page = lambda k: data[k << shift : min(k + 1 << shift, end)]
        return pages, sum(hashlib.sha256(page(k)).digest()[:size] != part[hashes + k * size :][:size] for k in range(pages))
    return 0, 0


def binds(steps):
    """Names that others have, of a list of steps that fill them in: the number of the needed library, and the name."""
    at = library = 0
    name = ""
    while at < len(steps):
        step, small, at = steps[at] & 0xF0, steps[at] & 15, at + 1
        if step == 0x10:
            library = small
        elif step == 0x30:
            library = small - 16 if small else 0
        elif step == 0x40:
            end = steps.index(0, at)
            name, at = steps[at:end].decode(), end + 1
        # Numbers that follow: a library; an addend, a segment's place, an address; a count and a distance.
        numbers = {0x20: 1, 0x60: 1, 0x70: 1, 0x80: 1, 0xA0: 1, 0xC0: 2}.get(step, 0)
        for _ in range(numbers):
            value, at = number(steps, at)
            library = value if step == 0x20 else library
        if step in (0x90, 0xA0, 0xB0, 0xC0):
            yield library, name


def read(path):
    """What one file says, in words; whether macOS would not load it."""
    with open(path, "rb") as file:
        data = file.read()
    machine, _, kind, commands = struct.unpack_from("<4I", data, 4)
    said, libraries, own, elsewhere, at, pages, wrong, strange = [], [], [], set(), 32, 0, 0, []
    for _ in range(commands):
        command, size, first, second = struct.unpack_from("<4I", data, at)
        if command in (*NEEDED, NAME, FOLDER):
            name = data[at + first : at + size].split(b"\0")[0].decode()
            said.append({NAME: "name ", FOLDER: "looks in "}.get(command, "needs ") + name)
            if command in NEEDED:
                libraries.append(name)
            if command == FOLDER or command in NEEDED and not name.startswith(("/usr/lib/", "/System/Library/Frameworks/")):
                strange.append(name)
        elif command == OLDEST:
            said.append(f"macOS {second >> 16}.{second >> 8 & 255} or newer")
            strange += ["too new a system"] if second > SAID else []
        elif command == SIGNATURE:
            pages, wrong = wrong_pages(data, data[first : first + second])
            said.append(f"signed, {pages} pages, {wrong} of them changed")
        elif command in EXPORTS or command in LOADING:
            if command in LOADING:
                _, _, *lists, first, second = struct.unpack_from("<10I", data, at + 8)
                for k in range(0, 6, 2):
                    elsewhere |= set(binds(data[lists[k] : lists[k] + lists[k + 1]]))
            own = list(exports(data[first : first + second])) if second else []
        at += size
    for k in (2, 3):
        if functions := sum(name.startswith(f"_fmi{k}") for name in own):
            said.append(f"{functions} functions of FMI {k}.0")
    said += [f"exports {name[1:]}" for name in own if name.startswith("_PyInit_")]
    for k, library in enumerate(libraries, 1):
        if ".framework/" in library:
            taken = sorted(name[1:] for place, name in elsewhere if place == k)
            said.append(f"of {library.rsplit('/', 1)[-1]} {' '.join(taken) or 'no function'}")
    if left := [name for place, name in elsewhere if place == OPEN]:
        said.append(f"{len(left)} names of Python")
        strange += [name for name in left if not name.startswith(("_Py", "__Py"))]
        strange += [] if any(name.startswith("_PyInit_") for name in own) else ["nothing for Python to call"]
    said += [f"WRONG: {name}" for name in strange]
    return f"{KINDS[kind]} for {'aarch64' if machine == AARCH64 else 'x86-64'}; {'; '.join(said)}", wrong > 0 or machine == AARCH64 and pages == 0 or bool(strange)


def main(paths):
    """The command line; how many files macOS would not load."""
    faults = 0
    for path in paths:
        said, fault = read(path)
        print(f"{path.rsplit('/', 1)[-1]}: {said}")
        faults += fault
    return faults


if __name__ == "__main__":
    sys.exit(1 if main(sys.argv[1:]) else 0)
