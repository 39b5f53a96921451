"""Reference implementations of the kernels in ``trunnion.cl.scan``."""

import math
import re
from collections.abc import Iterator, Sequence

MAJOR = re.compile(r"GOTO/|GODLTA/|CNTRL/|GOHOME/[-+.0-9]")
SEEN = re.compile(r"[A-Za-z\x7f-\xff\x00-\x08\x0b-\x1f]")
TEXT = re.compile(r"PPRINT|INSERT|DISPL|PARTNO|TPRINT|TOOLPATH|STOP|OPSTOP|REMARK")


def blank(text: str) -> str:
    """Return the text without white space around it."""
    return text.strip(" \t\r\n")


def fills(line: str, width: int) -> bool:
    """Whether a line ends with a dollar sign in the column ``width``."""
    content = line.rstrip(" \t\r")
    return len(content) == width and content.endswith("$")


def statements(data: bytes, text_width: int = 0) -> Iterator[tuple[str, int, bool]]:
    """Yield (statement, line, marked open) of a file, without comments, continuation lines joined by newlines.

    A text goes on behind a dollar sign in the column ``text_width`` that ends its line.
    """
    lines = data.split(b"\n")
    if lines[-1] == b"":
        lines.pop()
    at = 0
    while at < len(lines):
        first = at
        content = lines[at].decode("latin-1")
        if TEXT.match(re.sub(r"[ \t\r$]", "", content.lstrip(" \t\r")).upper()):
            whole = content
            at += 1
            while (is_open := text_width > 0 and fills(content, text_width)) and at < len(lines):
                content = lines[at].decode("latin-1")
                whole += "\n" + content
                at += 1
            yield blank(whole), first + 1, is_open
            continue
        whole = ""
        unfinished = False
        while True:
            raw = lines[at].decode("latin-1")
            content = raw.partition("$$")[0].rstrip(" \t\r")
            at += 1
            if not content.endswith("$"):
                # A comment in which a statement may stand is left to the interpreter.
                seen = (whole or content) and SEEN.search(raw.partition("$$")[2].rstrip(" \t\r"))
                whole += raw if seen else content
                break
            if at == len(lines):
                whole += content
                unfinished = True
                break
            whole += raw + "\n"
        whole = blank(whole)
        if whole:
            yield whole, first + 1, unfinished


def is_row(statement: str) -> bool:
    """Whether a statement is a motion."""
    return MAJOR.match(re.sub(r"[ \t\r\n$]", "", statement).upper()) is not None


def numbers(statement: str) -> list[float]:
    """The numbers of a GOTO as Python reads them."""
    plain = re.sub(r"\$[ \t\r]*\n", "", statement)
    return [float(field) for field in plain.partition("/")[2].split(",")]


def settle(vectors: Sequence[list[float] | None], seed: list[float]) -> list[list[float]]:
    """Fill and normalize modal vectors; None stands for a row without one."""
    result: list[list[float]] = []
    now = seed
    for vector in vectors:
        if vector is not None:
            length = math.sqrt(sum(part * part for part in vector))
            now = [part / length for part in vector] if abs(length - 1) > 1e-15 else list(vector)
        result.append(now)
    return result
