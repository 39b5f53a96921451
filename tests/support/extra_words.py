"""Extra words behind the blocks of a program: each changes what the run shows, or is reported."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program


def without_use(
    folder: Path, machine: str, frame: str, forms: Mapping[str, Iterable[str]]
) -> tuple[dict[str, list[str]], list[str], int]:
    """Words that a reader drops without a word about it, by block; blocks that are errors by themselves; and the count.

    frame   the program, with ``{lines}`` where a block goes
    forms   blocks, with ``|`` where an extra word goes if that is not behind them, and the words
    """
    program = folder / "part.nc"
    loaded = load_machine(machine)
    dropped: dict[str, list[str]] = {}
    faulty: list[str] = []
    count = 0

    def run(block: str, extra: str) -> Run:
        marked = block if "|" in block else f"{block}|"
        program.write_text(frame.format(lines=marked.replace("|", f" {extra}" if extra else "")), encoding="utf-8")
        return run_program(program, loaded)

    for block, extras in forms.items():
        plain = run(block, "")
        if plain.errors:
            faulty.append(f"{block}: {plain.errors[0].text}")
            continue
        shown = _shown(plain)
        for extra in extras:
            count += 1
            if _shown(run(block, extra)) == shown:
                dropped.setdefault(block, []).append(extra)
    return dropped, faulty, count


def _shown(run: Run) -> str:
    """All that a run shows of its words, besides the text of a block that an event repeats."""
    motions = (run.tip, run.kind, run.spindle, run.tool, run.feed, run.work_offset, run.machine_frame, run.inches)
    modes = [getattr(run.state, name).column().tolist() for name in ("feed_mode", "compensation", "radius", "edge")]
    events = [(event.before_row, event.kind, event.value) for event in run.events if event.kind not in _OF_TEXT]
    return repr(([column.tolist() for column in motions], modes, events, [each.code for each in run.diagnostics]))


_OF_TEXT = ("plane", "cycle32")
