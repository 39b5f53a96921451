"""Edits that change nothing: respaced, renumbered, said again, turned by 360 degrees, other words of arcs."""

import re
from collections.abc import Callable, Iterator

from tests.support.recall_proof.edits import Block, Edit, blocks_of, numbered, with_lines
from tests.support.recall_proof.equivalent_arcs import equivalent_arcs
from tests.support.recall_proof.languages import LANGUAGES, Language

#: What only whole programs can hold: an axis that is a turn further in one block turns there.
_THROUGHOUT = {"a turn further", "a turn back"}
#: Machine coordinates, in which an axis goes home.
_HOME = re.compile(r"\bSUPA\b|\bG53\b|\bM91\b|\bG28\b|\bG68\.2\b|\bPLANE\b|\bCYCL\b|_HOME|\bG8\d\b|\bCYCLE|\bG10\b")


def sound(text: str, family: str) -> Iterator[Edit]:
    """Yield every edit that changes nothing, of the whole program at once."""
    language = LANGUAGES[family]
    blocks = blocks_of(text, language)
    makers: dict[str, Callable[[Block], str]] = {
        "zeros behind": lambda b: _each_word(b, lambda n: n + "0" if "." in n else n),
        "zeros in front": lambda b: _each_word(b, lambda n: re.sub(r"(?<![\d.])(?=\d)", "0", n, count=1)),
        "plus signs": lambda b: _each_word(b, lambda n: n if n[0] in "+-" else "+" + n),
        "spaces": lambda b: re.sub(r"(?<=\d) (?=[XYZABCFSMIJ])", "   ", b.line) if b.cuts or b.rapids else b.line,
        "coordinates again": lambda b: _coordinates_again(b, language),
        "feeds again": lambda b: _feed_again(b, family),
        "motion again": lambda b: _motion_again(b, family),
        "words in another order": lambda b: _exchanged(b, family),
        "a turn further": lambda b: _turned(b, 360.0),
        "a turn back": lambda b: _turned(b, -360.0),
    }
    for kind, change in makers.items():
        lines = [change(block) for block in blocks]
        if lines != [block.line for block in blocks]:
            yield Edit(kind, 1, "\n".join(lines) + "\n")
            if kind in _THROUGHOUT:
                continue
            halves = [line if k % 2 else block.line for k, (line, block) in enumerate(zip(lines, blocks, strict=True))]
            yield Edit(kind, 1, "\n".join(halves) + "\n")
            for k, line in enumerate(lines):
                if line != blocks[k].line:
                    yield Edit(kind, k + 1, with_lines(blocks, k, line))
    if family != "Heidenhain":
        yield Edit("other numbers", 1, "\n".join(re.sub(r"^N(\d+)", r"N7\1", b.line) for b in blocks) + "\n")
        yield Edit("no numbers", 1, "\n".join(re.sub(r"^N\d+ ", "", b.line) for b in blocks) + "\n")
    note = {"Sinumerik": "; NOTE", "Heidenhain": "1 ; NOTE"}.get(family, "(NOTE)")
    for k, block in enumerate(blocks[:-1]):
        if block.cuts:
            yield Edit("a comment", k + 1, with_lines(blocks, k, note, block.line))
    yield from equivalent_arcs(blocks, family)
    yield from _lines_in_two(blocks, language)
    yield Edit("other line ends", 1, "\r\n".join(block.line for block in blocks) + "\r\n")


def _each_word(block: Block, change: Callable[[str], str]) -> str:
    if not (block.cuts or block.rapids):
        return block.line
    line = block.line
    for word in reversed(block.words):
        line = line[: word.start()] + word[1] + change(word[2]) + line[word.end() :]
    return line


def _coordinates_again(block: Block, language: Language) -> str:
    """A block with Z again, which is where it is; not for arcs, whose ends say more."""
    words = {word[1] for word in block.words}
    if not block.cuts or re.search(language.arc, block.code) or "Z" in words or "Z" not in block.before:
        return block.line
    last = block.words[-1]
    sign = "+" if re.search(r"X\+|Y\+", block.line) else ""
    value = block.before["Z"]
    return f"{block.line[: last.end()]} Z{sign if value >= 0 else ''}{value:.5f}{block.line[last.end() :]}"


def _feed_again(block: Block, family: str) -> str:
    if family in ("Heidenhain", "Fidia") or not block.cuts or not block.feed or re.search(r"\bF", block.code):
        return block.line
    last = block.words[-1]
    point = "" if "." in block.feed else "."
    return f"{block.line[: last.end()]} F{block.feed}{point}{block.line[last.end() :]}"


def _motion_again(block: Block, family: str) -> str:
    """A block that cuts in a line, with the G1 that is in force; Klartext says it anyway, and a Fidia has no other."""
    if family in ("Heidenhain", "Fidia") or not block.cuts or not block.line_in_force or re.search(r"\bG", block.code):
        return block.line
    first = block.words[0]
    return f"{block.line[: first.start()]}G1 {block.line[first.start() :]}"


def _exchanged(block: Block, family: str) -> str:
    """X and Y of a line in another order; Klartext has but one."""
    words = {word[1]: word for word in block.words}
    x, y = words.get("X"), words.get("Y")
    if family == "Heidenhain" or not (block.cuts or block.rapids) or x is None or y is None or x.end() + 1 != y.start():
        return block.line
    return f"{block.line[: x.start()]}{y[0]} {x[0]}{block.line[y.end() :]}"


def _turned(block: Block, by: float) -> str:
    """The endless axis C a turn further or back, wherever it is not home: in every machine here it may."""
    if _HOME.search(block.code):
        return block.line
    line = block.line
    for word in reversed(block.words):
        if word[1] == "C":
            value = float(word[2]) + by
            sign = "+" if word[2][0] in "+-" and value >= 0 else ""
            line = f"{line[: word.start()]}C{sign}{value:.5f}{line[word.end() :]}"
    return line


def _lines_in_two(blocks: list[Block], language: Language) -> Iterator[Edit]:
    """A straight cut with a point half-way; only where no rotary axis or vector turns the tool, and F is no time."""
    if any(re.search(r"\bG93\b", block.code) for block in blocks):
        return
    for k, block in enumerate(blocks):
        letters = [word[1] for word in block.words]
        known = all(letter in block.before for letter in letters) and set(letters) <= set("XYZ")
        if not (block.cuts and known) or block.cycle or re.search(language.arc, block.code) or block.arc_in_force:
            continue
        if re.search(r"\b[IJK][-+]?[\d.]", block.code):
            continue
        if re.search(r"\bR[LR0]\b|\bG4[012]\b", block.code) or block.compensated or " CC " in block.code:
            continue
        first = block.line
        for word in reversed(block.words):
            half = 0.5 * (block.before[word[1]] + float(word[2]))
            sign = "+" if word[2][0] in "+-" and half >= 0 else ""
            first = f"{first[: word.start()]}{word[1]}{sign}{half:.5f}{first[word.end() :]}"
        rest = " ".join(word[0] for word in block.words)
        second = numbered(block, f"L {rest}" if " L " in f" {block.code}" else rest)
        yield Edit("a line in two", k + 1, with_lines(blocks, k, first, *second))
