"""Checks all pairs of bodies over the whole of a run.

At one pose the distance of two bodies says how far they may move before they can touch; ``clearance`` says when they
have moved so far; there the distance is asked for again. What cannot touch costs a few questions for thousands of rows.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.simulation.collisions.bodies import Body, BodyKind, tool_bodies
from trunnion.simulation.collisions.pairs import body_pairs
from trunnion.simulation.collisions.queries import Solid
from trunnion.simulation.collisions.watching import PairWatch
from trunnion.simulation.finding import Finding
from trunnion.simulation.tools.profile import ToolShape
from trunnion.timing import axis_pieces

#: Bodies closer to each other than this are looked at again after moving by so much, mm: what touches and leaves within
#: it, less than half of it deep, may be missed.
STEP: Final = 0.5


def check_collisions(
    run: Run,
    bodies: Sequence[Body],
    tools: Mapping[str, ToolShape],
    *,
    near: float = 0.0,
    end: int | None = None,
    pairs_told: Callable[[int], None] | None = None,
) -> list[Finding]:
    """Find which bodies touch while a program runs, or come near each other.

    run         the program, read with the workpiece zero of the set-up where bodies of the machine are among the bodies
    bodies      of machine, fixtures and part: ``machine_bodies``, ``fixture_body``, ``part_body``
    tools       the tools in the spindle, by their names in ``run.tools``. A tool without a length has that of the
                machine
    near        distance in mm from which on two bodies are told that do not touch
    end         the first row that is left out; None: all are checked
    pairs_told  is told how many pairs of bodies are checked against each other

    list of Finding  in the order of the program

    Raises ``InputError`` if a tool of the run is not among ``tools``, or the workpiece zero or a tool's length is
    needed and not known.
    """
    lengths = _tool_lengths(run, bodies, tools)
    everything = list(bodies)
    for k, length in lengths.items():
        everything += tool_bodies(tools[run.tools[k]], run.machine, run.tools[k], length)
    pairs = body_pairs(run.machine, everything).checked
    if pairs_told is not None:
        pairs_told(len(pairs))
    solids = {k: Solid(everything[k].mesh) for pair in pairs for k in pair}
    watches = [
        PairWatch(run.machine, run.tools, (everything[i], everything[j]), (solids[i], solids[j]), near, STEP)
        for i, j in pairs
    ]
    for pieces in axis_pieces(run, lengths, end):
        for watch in watches:
            watch.follow(pieces)
    found = [each for watch in watches for each in watch.findings()]
    return sorted(found, key=lambda each: (each.rows[0], each.begin, each.between))


def _tool_lengths(run: Run, bodies: Sequence[Body], tools: Mapping[str, ToolShape]) -> dict[int, float]:
    """Lengths of the tools that move, by their index in ``run.tools``."""
    machine, file = run.machine, run.files[0] if run.files else ""
    used = [int(k) for k in run.state.tool.distinct() if run.tools[int(k)] not in ("", "0")]
    problems = [
        Problem(file, 0, Wording("SIM150", "tool_not_known", tools=run.tools[k]))
        for k in used
        if run.tools[k] not in tools
    ]
    iron = any(body.kind is BodyKind.MACHINE for body in bodies)
    if iron and machine.workpiece_zero is None:
        problems.append(Problem(file, 0, Wording("SIM310", "collision_check_machine")))
    lengths = {}
    for k in used:
        if run.tools[k] in tools:
            lengths[k] = tools[run.tools[k]].length or run.length_of(run.tools[k]) or 0.0
            if iron and not lengths[k]:
                problems.append(Problem(file, 0, Wording("SIM310", "length_tool_not", tools=run.tools[k])))
    if problems:
        raise InputError(problems)
    return lengths
