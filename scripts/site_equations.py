"""Equations of the site: a hook of MkDocs that turns TeX into MathML, and a check of the pages that were built.

`$...$` and `$$...$$` become MathML when the site is built. Browsers draw that themselves (Chromium and Edge from 109 on, Firefox,
Safari), so that pages need no script, no fonts and no network. GitHub draws the same sources.

`python scripts/site_equations.py build/site` ends with an error where TeX is left in the text of a page.
"""

import re
import sys
from html import escape, unescape
from html.parser import HTMLParser
from pathlib import Path

# What pymdownx.arithmatex makes of `$...$` and `$$...$$` with `generic: true`.
FOUND = re.compile(r'<(span|div) class="arithmatex">(.*?)</\1>', re.DOTALL)
NUMBER = re.compile(r"\s*\\tag\{([^{}]*)\}")
BOLD_COMMAND = re.compile(r"\\(?:mathbf|boldsymbol)\b")
# Bold letters of mathematics have characters of their own.
BOLD_LETTER = re.compile("[\U0001d400-\U0001d433\U0001d468-\U0001d49b\U0001d6a8-\U0001d6e1\U0001d71c-\U0001d755\U0001d7ce-\U0001d7d7]")
# A dot as an accent comes to lie on tall letters in Chromium; as a script of full size it stands above them.
DOT = re.compile('<mover accent="true">((?:(?!<mover).)*?)<mo>\u02d9</mo></mover>')
# TeX that a reader would see: a command, a delimiter, an index or a power in braces.
TEX = re.compile(r"\\[A-Za-z]+|\\[\[\](){}]|\$\$|\$[^\s$](?:[^$\n]*[^\s$])?\$|[_^]\{")


def to_mathml(source, display):
    """MathML of TeX. Raises ValueError where it is not understood, or loses its bold letters."""
    import math_core  # of scripts/site-requirements.txt

    converter = math_core.LatexToMathML(fancy_error=False)
    try:
        mathml = converter.convert_with_local_state(source, displaystyle=display)
    except math_core.LatexError as why:
        raise ValueError(f"{why}: {source}") from None
    wanted, there = len(BOLD_COMMAND.findall(source)), len(BOLD_LETTER.findall(mathml))
    if there < wanted:
        raise ValueError(f"{wanted} bold letters, of which {there} came out: {source}")
    return DOT.sub('<mover accent="false">\\1<mo scriptlevel="0">\u02d9</mo></mover>', mathml)


def equation(found):
    """HTML of one equation; an equation of its own line has its number at the right."""
    display = found[1] == "div"
    source = unescape(found[2]).strip()
    source = source.removeprefix("\\[" if display else "\\(").removesuffix("\\]" if display else "\\)").strip()
    if not display:
        return to_mathml(source, False)
    number = NUMBER.search(source)
    mathml = to_mathml(NUMBER.sub("", source), True)
    beside = f'<span class="number">({escape(number[1])})</span>' if number else ""
    return f'<div class="equation">{mathml}{beside}</div>'


def on_page_content(html, page, **_):
    """Called by MkDocs with the HTML of a page."""
    try:
        return FOUND.sub(equation, html)
    except ValueError as why:
        from mkdocs.exceptions import PluginError

        raise PluginError(f"{page.file.src_uri}: {why}") from None


class Text(HTMLParser):
    """The text of a page that is no code."""

    CODE = {"code", "pre", "script", "style", "annotation"}

    def __init__(self):
        super().__init__()
        self.inside, self.text, self.equations = 0, [], 0

    def handle_starttag(self, tag, attrs):
        self.inside += tag in self.CODE
        self.equations += tag == "math"
        # An equation that the hook did not see, or that was not understood.
        if {"arithmatex", "math-core-error"} & set((dict(attrs).get("class") or "").split()):
            self.text.append("\\unconverted ")

    def handle_endtag(self, tag):
        self.inside -= tag in self.CODE

    def handle_data(self, data):
        if not self.inside:
            self.text.append(data)


def check(site):
    """Sentences about TeX that is left in the pages, and the number of equations there are."""
    left, equations = [], 0
    for page in sorted(Path(site).rglob("*.html")):
        text = Text()
        text.feed(page.read_text(encoding="utf-8"))
        equations += text.equations
        seen = "".join(text.text)
        for tex in TEX.finditer(seen):
            around = " ".join(seen[max(0, tex.start() - 30) : tex.end() + 30].split())
            left.append(f"{page}: {tex[0]!r} is left in: {around}")
    return left, equations


if __name__ == "__main__":
    left, equations = check(sys.argv[1])
    for sentence in left:
        print(f"error: {sentence}", file=sys.stderr)
    if not equations:
        print("error: the pages have no equations", file=sys.stderr)
    sys.exit(bool(left) or not equations)
