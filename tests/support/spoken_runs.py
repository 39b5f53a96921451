"""One run of each command in a language: what it prints, and the pages that it writes, as lines of text."""

import contextlib
import io
import json
import re
import shutil
from collections.abc import Iterator
from datetime import UTC, datetime
from html import unescape
from pathlib import Path

import numpy as np

from tests.support.frozen_results import BLADE, CONTOUR, HUB, HUB_MPF, PLATE, SET, STOCK, TOOLS, ZERO
from tests.support.locations import TESTS
from tests.support.recordings import recorded
from trunnion import load_machine, read_program
from trunnion.timing import time_run

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
    "new": ("new", "our_mill", "--like", "yl569"),
    "import_nx": ("import", "foreign/mill.tcl", "foreign/mill.def", "foreign/mill.pui", "--output", "of_nx"),
    "import_mastercam": ("import", "foreign/mill.pst", "--like", "yl569", "--output", "of_mastercam"),
    "import_swivel_data": ("import", "foreign/swivel.arc", "--output", "of_swivel_data"),
    "import_compared": ("import", "foreign/nck.arc", "--machine", "yl569"),
    "import_refused": ("import", "foreign/nck.arc", "foreign/mill.tcl", "--output", "refused"),
    "check": ("check", "our_mill.toml"),
    "check_project": ("check", "examples/project/part.toml"),
    "check_program": ("check", "yl569", "--program", HUB_MPF),
    "machines": ("machines",),
    "controls": ("controls",),
    "control": ("controls", "sinumerik_840d"),
    "build": ("build", "our_mill"),
    "freecad": ("freecad", "install", "--folder", "Macro"),
    "fusion": ("fusion", "install", "--folder", "Posts"),
    "post.html": ("post", HUB, "--machine", "yl569", *SET, "--explain", "--output", "hub.mpf", "--report", "{}"),
    "post_suggest": ("post", "no_speed.cls", "--machine", "yl569", "--suggest", "suggested.toml"),
    "post_refused": ("post", "lean.cls", "--machine", "yl569", "--output", "refused.mpf"),
    "convert": ("convert", HUB_MPF, "--machine", "yl569", "--to-machine", "mikron_600u", "--output", "c.h"),
    "convert_to_cl": ("convert", HUB_MPF, "--machine", "yl569", "--to-cl", "--output", "c.cls"),
    "place": ("place", HUB, "--machine", "yl569", "--turns", "90", "--tool-length", "120"),
    "verify.html": ("verify", HUB_MPF, "--machine", "yl569", "--cl", CONTOUR, "--report", "{}"),
    "verify_recorded.html": (
        "verify", HUB_MPF, "--machine", "yl569", "--recorded", "recorded.csv", "--report", "{}"
    ),
    "diff": ("diff", HUB_MPF, "golden/yl569/3_blade_finish.expected.mpf", "--machine", "yl569"),
    "simulate.html": (
        "simulate", "examples/simulation/plate_top.mpf", "--machine", "yl569", *STOCK, *TOOLS, "--part", PLATE,
        "--report", "{}",
    ),
    "fit": ("fit", "lean.cls", "--machines", "yl569,mikron_600u"),
    "view.html": ("view", HUB_MPF, "--machine", "yl569", "--output", "{}"),
    "twin": ("twin", HUB_MPF, "--machine", "yl569", "--device-xml", "devices.xml"),
    "record": ("record", "opc.tcp://127.0.0.1:9", "--output", "record.csv"),
    "impeller": ("impeller", "model", "examples/impeller/impeller.toml", "--tolerance", "0.1", "--output", "wheel.stl"),
    "batch": ("batch", "examples/batch/jobs.toml", "--workers", "1"),
    "test": ("test", "examples/project"),
    "test_changed": ("test", "changed"),
    "explain": ("explain", "CL110", "NC110", "tip"),
}  # fmt: skip

#: Commands of which no run is compared, and why.
NOT_RUN: dict[str, str] = {
    "schema": "prints JSON for editors, which is the same in all languages",
    "completion": "prints what a shell runs",
    "prepare": "compiles for minutes; its one line is a text of the catalogue",
}


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


def lay_out_more(folder: Path) -> None:
    """Write what these runs read besides the jobs whose results are frozen."""
    text = (folder / HUB).read_text(encoding="utf-8")
    without = "".join(line for line in text.splitlines(keepends=True) if "SPINDL" not in line)
    (folder / "no_speed.cls").write_text(without, encoding="utf-8")
    shutil.copytree(TESTS / "data" / "foreign", folder / "foreign")
    shutil.copytree(folder / "examples" / "project", folder / "changed")
    program = folder / "changed" / "plate_top.mpf"
    program.write_text(program.read_text(encoding="utf-8").replace("F", "F1", 1), encoding="utf-8")
    write_recording(folder / "recorded.csv", folder / HUB_MPF)


def write_recording(file: Path, program: Path) -> None:
    """Write what a machine shows while it runs a program, with a gap."""
    machine = load_machine("yl569")
    timed = time_run(read_program(program, machine=machine))
    made = recorded(timed, np.arange(0.0, timed.duration, 1.0))
    names = list(made.values)
    rows = [",".join(["source", "received", "mark", *names])]
    for k, stamp in enumerate(made.source.tolist()):
        at = datetime.fromtimestamp(stamp / 1e6, UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        rows.append(",".join([at, at, "gap" if k == 5 else "", *(f"{made.values[name][k]:.6f}" for name in names)]))
    file.write_text("\n".join(rows) + "\n", encoding="utf-8")


def text_lines(page: str) -> Iterator[str]:
    """Yield the texts of a page: what stands between tags, and what tags say of themselves."""
    for each in re.findall(r'<script type="application/json" id="[^"]*report">(.*?)</script>', page, flags=re.DOTALL):
        yield from _texts_of(json.loads(each))
    plain = re.sub(r"<(script|style)\b.*?</\1>", "", page, flags=re.DOTALL)
    yield from (unescape(each) for each in re.findall(r'(?:title|alt|aria-label|placeholder)="([^"]+)"', plain))
    for each in re.split(r"<[^>]*>", plain):
        if text := unescape(each).strip():
            yield " ".join(text.split())


def _texts_of(shown: object) -> Iterator[str]:
    """Yield the texts of the plots of a page."""
    if isinstance(shown, dict):
        yield from (shown[name] for name in ("title", "note", "name", "limitName", "first") if shown.get(name))
        yield from shown.get("words", {}).values()
        yield from (str(name) for _, name in shown.get("marks", ()))
        yield from _texts_of([*shown.get("plots", ()), *shown.get("lines", ())])
    elif isinstance(shown, list):
        for each in shown:
            yield from _texts_of(each)
