"""What no program should do, whatever it is for: faults of modal state, and words that nobody knows."""

from pathlib import Path

import numpy as np

from trunnion.errors import InputError, Severity
from trunnion.model.run import Diagnostic, ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.kinematics.rapid_feeds import approach_rows
from trunnion.verification.matching.hole_matching import hole_approach_rows, hole_rows, match_holes
from trunnion.verification.matching.path_matching import CHUNK, POSITION_WORDS
from trunnion.verification.results import Check, Place

_FEEDLESS = {
    "no feed": "moves at feed, but no feed was said",
    "spindle off": "moves at feed, spindle off",
    "no time": "moves with inverse time (G93), and has no F of its own",
}

#: Rotary motion below this, degrees, is none.
_TURNED = 1e-3

#: Height and sideways motion below this, mm, are none.
_MOVED = 1e-3


def modal(context: Context) -> Check:
    """Motion without feed or spindle, TCP on where it must be off, rapids below the retract height, no end."""
    run = context.run
    places = _without_feed_or_spindle(context)
    places += _tcp_left_on(context)
    places += _turned_under_tcp(context)
    places += _low_rapids(context)
    end = next((event for event in run.events if event.kind == "end"), None)
    if end is None and len(run):
        last = max(context.last_line, run.lines[-1])
        places.append(Place(last, -1, 0.0, "the program has no end (M30 or M2) after this"))
    for event in run.events:
        if event.kind == "tool_change" and 0 < event.before_row <= len(run) and _spindle_at(run, event.before_row):
            places.append(context.at(event, 0.0, "changes the tool while the spindle turns"))
    places.sort(key=lambda place: place.nc_line)
    # With a CL file the check "spindle" says what the spindle does.
    cut = "feed and spindle" if context.expected is None else "feed"
    good = f"{cut} at every cut, TCP off at home, no low rapids, a proper end"
    return check_from_places("modal", "modal state", places, good)


def _spindle_at(run: Run, before_row: int) -> bool:
    """Whether the spindle turns before a row, as events tell."""
    turning = False
    for event in run.events:
        if event.kind == "spindle" and event.before_row <= before_row:
            turning = event.value not in (0, 0.0, "off", "oriented", None)
        if event.kind == "tool_change" and event.before_row == before_row:
            return turning
    return turning


def _without_feed_or_spindle(context: Context) -> list[Place]:
    run = context.run
    places: list[Place] = []
    found = {"no feed": False, "spindle off": False, "no time": False}
    for start in range(0, len(run), CHUNK):
        end = min(start + CHUNK, len(run))
        cuts = run.kind[start:end] != Kind.RAPID
        faults = {"no feed": cuts & ~(run.state.feed.part(start, end) > 0.0)}
        timed = run.state.feed_mode.part(start, end) == 93
        said = run.programmed[start:end]
        # Motions that blocks do not write themselves, as those of cycles, have their feeds from elsewhere.
        faults["no time"] = cuts & timed & (said != 0) & ((said & int(ProgrammedWord.FEED)) == 0)
        # With a CL file it says where the spindle turns; some tools do not.
        if context.expected is None:
            off = (run.state.spindle.part(start, end) == 0) | (run.state.rpm.part(start, end) <= 0.0)
            faults["spindle off"] = cuts & off & ~run.state.machine_frame.part(start, end)
        for what, rows in faults.items():
            if not found[what] and rows.any():
                found[what] = True
                places.append(context.place(start + int(np.argmax(rows)), 0.0, _FEEDLESS[what]))
    return places


def _tcp_left_on(context: Context) -> list[Place]:
    run = context.run
    places = []
    frame = run.state.machine_frame.rows_with(True)
    along = [event.before_row for event in run.events if event.kind == "retract"]  # the tool's own axis, at its tip
    wrong = frame[run.state.tcp.at(frame) & ~np.isin(frame, along)]
    if len(wrong):
        places.append(context.place(int(wrong[0]), 0.0, "moves in the machine's frame with TCP on"))
    for event in run.events:
        if event.tcp and event.kind in ("tool_change", "end"):
            what = "changes the tool" if event.kind == "tool_change" else "ends the program"
            places.append(context.at(event, 0.0, f"{what} with TCP on"))
    return places


def _turned_under_tcp(context: Context) -> list[Place]:
    """Rapids that swing rotary axes although TCP has only just been switched on: they were not placed before it."""
    run = context.run
    places = []
    for first in run.state.tcp.rows_changing_to(True):
        end = min(first + 16, len(run))
        turns = np.abs(np.diff(run.chunk(first, end).joints[:, list(run.machine.rotary)], axis=0)).max(axis=1)
        for row in range(first, end):
            if run.kind[row] != Kind.RAPID or not run.state.tcp[row]:
                break
            turned = float(turns[row - first])
            if turned > _TURNED and not run.state.machine_frame[row]:
                text = f"swings a rotary axis by {turned:.3f} degrees at rapid with TCP on: place it before TRAORI"
                places.append(context.place(row, turned, text))
            if run.programmed[row] & int(POSITION_WORDS):
                break
    return places[:MAX_PLACES]


def _low_rapids(context: Context) -> list[Place]:
    """Rapids that go sideways below the height to which the tool was last drawn back, and that no CL file asks for."""
    run = context.run
    rapids = np.flatnonzero(run.kind == Kind.RAPID)
    rapids = rapids[~run.state.machine_frame.at(rapids)]
    suspect = np.zeros(len(run), np.bool_)
    suspect[rapids] = True
    if context.matching is not None:
        assert context.expected is not None
        for nc, cl in context.matching.all_pair_chunks():
            suspect[nc[context.expected.kind(cl) == Kind.RAPID]] = False
    made = match_holes(run, context.expected)
    suspect[hole_rows(made)] = False  # they have a check of their own
    if context.matching is not None:
        assert context.expected is not None
        allowed = max(section.tolerances.tip for section in context.expected.sections)
        suspect[list(hole_approach_rows(run, context.matching.extra, made, allowed))] = False
    suspect[approach_rows(run)] = False  # as high as home is, which nobody chose
    if not suspect.any():
        return []
    every = rapids[(run.programmed[rapids] & int(POSITION_WORDS)) != 0]
    before, after, tools = run.positions(np.maximum(every - 1, 0)), run.positions(every), run.state.tool.at(every)
    places: list[Place] = []
    retracts = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    height: float | None = None
    axis = np.zeros(3)
    tool = -1
    for k, row in enumerate(every.tolist()):
        last = every[k - 1] if k else -1
        drawn_back = bool(((retracts > last) & (retracts <= row)).any())
        if np.abs(after.axis[k] - axis).max() > 1e-6 or tools[k] != tool or drawn_back:
            height, axis, tool = None, after.axis[k], int(tools[k])
        here, there = before.tip[k], after.tip[k]
        way = there - here
        up = float(way @ axis)
        aside = float(np.linalg.norm(way - up * axis))
        high = max(float(here @ axis), float(there @ axis))
        if suspect[row] and height is not None and aside > _MOVED and high < height - _MOVED:
            text = f"rapid goes sideways {height - high:.3f} mm below the retract height"
            places.append(context.place(row, height - high, text))
            if len(places) >= MAX_PLACES:
                break
        elif height is None or (aside <= _MOVED and up > _MOVED):
            height = float(there @ axis)
    return places


def words(context: Context) -> Check:
    """Words that the reader does not know or could not act upon."""
    run = context.run
    errors = [finding for finding in run.diagnostics if finding.severity is Severity.ERROR]
    expected = context.expected
    if expected is not None and errors and expected.insert_texts:
        errors = [finding for finding in errors if not _inserted(finding, expected.insert_texts)]
    if expected is not None:  # no CL file asks for a constant surface speed: SPINDL has become rev/min
        unasked = ("G96",) if expected.compensates else ("G96", "G41", "G42")
        errors += [f for f in run.diagnostics if f not in errors and f.text.startswith(unasked)]
    places = [Place(finding.line, -1, 0.0, finding.text) for finding in errors]
    warnings = len(run.diagnostics) - len(errors)
    good = "every word is known" + (f", {warnings} remarks" if warnings else "")
    check = check_from_places("words", "every word known", places, good)
    if check.passed and warnings:
        told = tuple(Place(f.line, -1, 0.0, f.text) for f in run.diagnostics[:MAX_PLACES])
        return Check(check.key, check.title, True, check.summary, places=told)
    return check


def _inserted(finding: Diagnostic, texts: set[str]) -> bool:
    """Whether the block is one that the CL file put into the program itself (INSERT)."""
    try:
        lines = Path(finding.file).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise InputError([]) from error
    if not 0 < finding.line <= len(lines):
        return False
    line = lines[finding.line - 1].lstrip("/").strip()
    return line in texts or line.partition(" ")[2].strip() in texts
