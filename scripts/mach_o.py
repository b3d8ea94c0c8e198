#!/usr/bin/env python3
"""What a library for macOS says of itself, read without a Mac: its name, oldest system, needed libraries, functions of FMI, and whether each page has
the hash of its signature. Fails where one has not, or where a library for aarch64, of which macOS loads no other, is not signed.
Usage: mach_o.py LIBRARY ...
"""

import hashlib
import struct
import sys

AARCH64 = 0x0100000C
# Load commands: needed library, own name, signature, lists of exports (two forms), oldest system.
NEEDED, NAME, SIGNATURE, EXPORTS, LOADING, OLDEST = 0xC, 0xD, 0x1D, (0x80000033,), (0x22, 0x80000022), 0x32
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


def main(paths):
    """The command line; how many libraries macOS would not load."""
    faults = 0
    for path in paths:
        with open(path, "rb") as file:
            data = file.read()
        machine, commands, at, pages, wrong = struct.unpack_from("<I", data, 4)[0], struct.unpack_from("<I", data, 16)[0], 32, 0, 0
        said = []
        for _ in range(commands):
            command, size, first, second = struct.unpack_from("<4I", data, at)
            if command in (NEEDED, NAME):
                said.append(("name " if command == NAME else "needs ") + data[at + first : at + size].split(b"\0")[0].decode())
            elif command == OLDEST:
                said.append(f"macOS {second >> 16}.{second >> 8 & 255} or newer")
            elif command == SIGNATURE:
                pages, wrong = wrong_pages(data, data[first : first + second])
                said.append(f"signed, {pages} pages, {wrong} of them changed")
            elif command in EXPORTS or command in LOADING:
                first, second = (first, second) if command in EXPORTS else struct.unpack_from("<2I", data, at + 40)
                names = list(exports(data[first : first + second])) if second else []
                said.append(", ".join(f"{sum(name.startswith(f'_fmi{k}') for name in names)} functions of FMI {k}.0" for k in (2, 3)))
            at += size
        print(f"{path.rsplit('/', 1)[-1]}: {'; '.join(said)}")
        faults += wrong > 0 or (machine == AARCH64 and pages == 0)
    return faults


if __name__ == "__main__":
    sys.exit(1 if main(sys.argv[1:]) else 0)
