"""One run of each command in a language: what it prints, and the pages that it writes, as lines of text."""

import contextlib
import io
import re
from collections.abc import Iterator
from html import unescape
from pathlib import Path

from tests.support.frozen_results import BLADE, HUB, HUB_MPF, SET, ZERO

#: Runs by their names; ``{}`` is a page that the run writes, whose ending stands behind the name.
RUNS: dict[str, tuple[str, ...]] = {
    "sheet.html": ("post", HUB, BLADE, "--machine", "yl569", *SET, "--output", "sheet.mpf", "--sheet", "{}"),
    "sensitivity.html": ("sensitivity", HUB_MPF, "--machine", "yl569", *ZERO, "--report", "{}"),
    "kinematics": ("kinematics", "generic_nutated_b45_c"),
    "kinematics_markdown": ("kinematics", "yl569", "--format", "markdown"),
    "kinematics_latex": ("kinematics", "dmu65", "--format", "latex"),
    "reach.svg": ("reach", HUB, "--machine", "yl569", *ZERO, "--step", "60", "--plot", "{}"),
    "curve.svg": ("curve", "examples/impeller/blade_points.csv", "--tolerance", "0.01", "--picture", "{}"),
    "unknown": ("info", "unknown.cls"),
    "info.html": ("info", HUB, BLADE, "--plot", "{}"),
    "survey.html": ("survey", "pile", "--machine", "yl569", "--workers", "1", "--report", "{}"),
}  # fmt: skip


def lines_of(run: tuple[str, ...], ending: str, language: str) -> list[str]:
    """Run a command in this process, in the working folder; the lines that a reader sees.

    ending  of the page that it writes, with its point; empty: it writes none
    """
    from trunnion.cli import main

    page = Path(f"page{ending}")
    page.unlink(missing_ok=True)
    out, told = io.StringIO(), io.StringIO()
    words = [each.replace("{}", str(page)) for each in run]
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(told), contextlib.suppress(SystemExit):
        main([*words, "--language", language] if "--help" not in words else ["--language", language, *words])
    found = out.getvalue().splitlines() + told.getvalue().splitlines()
    if page.is_file():
        found += list(text_lines(page.read_text(encoding="utf-8")))
    return found


def text_lines(page: str) -> Iterator[str]:
    """Yield the texts of a page: what stands between tags, and what tags say of themselves."""
    plain = re.sub(r"<(script|style)\b.*?</\1>", "", page, flags=re.DOTALL)
    yield from (unescape(each) for each in re.findall(r'(?:title|alt|aria-label|placeholder)="([^"]+)"', plain))
    for each in re.split(r"<[^>]*>", plain):
        if text := unescape(each).strip():
            yield " ".join(text.split())
