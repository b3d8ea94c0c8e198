"""A Markdown text whose links to files of the project lead to an address, for where its files are not beside it (crates.io, PyPI).

Usage: absolute_links.py ADDRESS < README.md > out.md
ADDRESS is where the files of the project are read, with the folder of their version: pictures are taken from there, too.
"""

import re
import sys

# Links and pictures, `](target)`; what has a scheme or is a place on the page stays.
LINK = re.compile(r"(\]\()(?![a-z][a-z0-9+.-]*:|#)([^)\s]+)")


def absolute(text, address):
    """The text with absolute links, but for what stands in blocks of code."""
    parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
    address = address.rstrip("/")
    return "".join(part if part.startswith("```") else LINK.sub(rf"\1{address}/\2", part) for part in parts)


if __name__ == "__main__":
    (address,) = sys.argv[1:]
    sys.stdout.write(absolute(sys.stdin.read(), address))
