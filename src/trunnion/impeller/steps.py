"""The machining steps of an impeller and their data: ``[[operation]]`` of ``impeller.toml``.

Units: mm, mm/min, rev/min, degrees.
"""

import unicodedata
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.messages import as_written
from trunnion.impeller.paths.passes import Stepover, Way
from trunnion.messages import Wording
from trunnion.output.subprograms import DEVICE_NAME
from trunnion.records import dataclass
from trunnion.simulation.tools.library.library import LibraryTool
from trunnion.simulation.tools.sizes import ToolKind, ToolSizes
from trunnion.transliteration import spelled

_GREATEST: Final = 1000.0

#: Passes are no nearer to each other, mm.
_LEAST: Final = 0.01

#: Greatest angle between tool axis and Z where nothing is stated, degrees.
_TILT: Final = 100.0


#: Letters of a name at most: files have the names of the impeller and of a step.
_LONGEST_NAME: Final = 80


class StepKind(StrEnum):
    """What a step machines."""

    STOCK_ROUGHING = "stock roughing"
    STOCK_FINISHING = "stock finishing"
    CHANNEL_ROUGHING = "channel roughing"
    HUB_FINISH = "hub finish"
    BLADE_FINISH = "blade finish"
    ROOT_BLEND = "root blend"
    FLANK_MILLING = "flank milling"


#: Steps that go once round the whole part; the others are cut once for each blade or channel.
ROUND_STEPS: Final = (StepKind.STOCK_ROUGHING, StepKind.STOCK_FINISHING)

#: Steps that go down in depth.
_DEEP: Final = (StepKind.STOCK_ROUGHING, StepKind.CHANNEL_ROUGHING)

#: Kinds of tools that a step may have.
_TOOLS: Final[Mapping[StepKind, tuple[ToolKind, ...]]] = {
    kind: (ToolKind.FLAT,) if kind is StepKind.STOCK_ROUGHING else (ToolKind.BALL, ToolKind.TAPER_BALL)
    for kind in StepKind
}

#: Ways that a step may have; the first one is its own.
_WAYS: Final[Mapping[StepKind, tuple[Way, ...]]] = {
    StepKind.STOCK_ROUGHING: (Way.SPIRAL,),
    StepKind.STOCK_FINISHING: (Way.SPIRAL,),
    StepKind.CHANNEL_ROUGHING: (Way.BOTH_WAYS,),
    StepKind.HUB_FINISH: (Way.BOTH_WAYS,),
    StepKind.BLADE_FINISH: (Way.ONE_WAY, Way.BOTH_WAYS, Way.SPIRAL),
    StepKind.ROOT_BLEND: (Way.ONE_WAY, Way.BOTH_WAYS, Way.SPIRAL),
    StepKind.FLANK_MILLING: (Way.ONE_WAY,),
}


@dataclass(frozen=True, slots=True)
class MachiningStep:
    """A step and its data.

    tool             by its number
    stepover         from one pass to the next; of stock roughing, the width that one turn may cut; 0 of flank milling
    step_down        from one layer, or turn, to the next; 0 where the step has none
    allowance        that stays on blades, or on the form of the shroud
    hub_allowance    that stays on the hub
    rpm              of the spindle, clockwise
    feed, lead_feed  of cuts, and of all that leads to them and away
    lead             radius of the arcs that lead in and out; 0: none
    tilt             of the tool axis, outward, in stock finishing; in steps that choose it, the greatest from Z
    overcut          that flank milling may leave
    clearance        wanted of cutter, shank and holder, and of links from the stock
    tolerance        of the ball's centre
    coolant          a CL word; empty: none
    published_minutes  for one blade or channel, to compare with; 0: none
    line             of the definition
    """

    kind: StepKind
    name: str
    tool: int
    stepover: Stepover
    step_down: float
    allowance: float
    hub_allowance: float
    rpm: float
    feed: float
    lead_feed: float
    lead: float
    way: Way
    tilt: float
    overcut: float
    clearance: tuple[float, float, float, float]
    tolerance: float
    coolant: str
    published_minutes: float
    line: int


def read_steps(root: Table, tools: Sequence[LibraryTool]) -> tuple[MachiningStep, ...]:
    """Read the tables ``[[operation]]``, in the order of machining; mistakes are added to the problems of ``root``."""
    found: list[MachiningStep] = []
    taken: dict[str, str] = {}
    stated = [table.to_dict().get("number") for table in root.tables("tool")]
    for table in root.tables("operation"):
        step = _read_step(table, {tool.number: tool for tool in tools}, stated)
        if step is None:
            continue
        other = taken.setdefault(file_stem(step.name).casefold(), table.path)
        if other != table.path:
            alike = step.name in {each.name for each in found}
            table.add_problem(
                "name",
                Wording("IMP312", "too", other=other) if alike else Wording("IMP312", "makes_same_file", other=other),
            )
        found.append(step)
    return tuple(found)


def read_name(table: Table, default: str) -> str:
    """Return the name of a table: one line that can be printed."""
    name = table.text("name", default)
    if not (name.strip() and name.isprintable() and len(name) <= _LONGEST_NAME):
        table.add_problem("name", Wording("IMP312", "is", name=as_written(name), longest_name=_LONGEST_NAME))
        return default
    return name


def file_stem(name: str) -> str:
    """Return a name as that of a file and of a program: letters, digits and underscores; Chinese as pinyin.

    Examples
    --------
    >>> file_stem("Gehäuse 2"), file_stem("CON"), file_stem("叶轮 1")
    ('Gehause_2', 'CON_', 'YeLun_1')
    """
    plain = "".join(one for one in unicodedata.normalize("NFKD", name) if not unicodedata.combining(one))
    stem = "".join(letter if letter.isalnum() else "_" for letter in spelled(plain, "ascii"))
    return f"{stem}_" if DEVICE_NAME.fullmatch(stem) else stem


def _read_step(table: Table, tools: Mapping[int | None, LibraryTool], stated: Sequence[object]) -> MachiningStep | None:
    """Return the step of a table; None if its kind is not known, which the table then says.

    ``stated`` are the numbers of all tools, those with mistakes too.
    """
    word = table.text("kind", one_of=list(StepKind))
    if word not in list(StepKind):
        table.mark_read(*table.keys())
        return None
    kind = StepKind(word)
    tool = table.integer("tool", at_least=0)
    if tool in tools and tools[tool].sizes.kind not in _TOOLS[kind]:
        table.add_problem(
            "tool",
            Wording(
                "IMP312", "mill", tool=tool, kind=tools[tool].sizes.kind, step_kind=kind, tools=tuple(_TOOLS[kind])
            ),
        )
    elif tool not in tools and tool not in stated:
        table.add_problem(
            "tool",
            Wording(
                "IMP312",
                "not_among_tools",
                tool=tool,
                tools=tuple(str(number) for number in tools if number is not None),
            ),
        )
    feed = table.number("feed_mm_min", above=0.0, at_most=100_000.0)
    ways = _WAYS[kind]
    step = MachiningStep(
        kind=kind,
        name=read_name(table, word.replace(" ", "_").upper()),
        tool=tool,
        stepover=Stepover() if kind is StepKind.FLANK_MILLING else _read_stepover(table),
        step_down=table.number("step_down_mm", at_least=_LEAST, at_most=_GREATEST) if kind in _DEEP else 0.0,
        allowance=table.number("allowance_mm", 0.0, at_least=0.0, at_most=_GREATEST),
        hub_allowance=_read_hub_allowance(table, kind),
        rpm=table.number("rpm", above=0.0, at_most=200_000.0),
        feed=feed,
        lead_feed=table.number("lead_feed_mm_min", feed, above=0.0, at_most=100_000.0),
        lead=table.number("lead_mm", 0.0, at_least=0.0, at_most=100.0),
        way=Way(table.text("way", ways[0], one_of=ways) or ways[0]),
        tilt=_read_tilt(table, kind),
        overcut=_read_overcut(table, kind),
        clearance=_read_clearance(table),
        tolerance=table.number("tolerance_mm", 0.01, at_least=0.0005, at_most=1.0),
        coolant=table.text("coolant", "", one_of=("", "ON", "FLOOD", "MIST", "THRU", "AIR")),
        published_minutes=table.number("published_min", 0.0, at_least=0.0),
        line=table.line,
    )
    if tool in tools:
        _check_reach(table, step, tools[tool].sizes)
    table.report_unread_keys()
    return step


def _check_reach(table: Table, step: MachiningStep, sizes: ToolSizes) -> None:
    """Add what a tool cannot take at once: deeper than its flutes are long, or wider than the mill is."""
    flutes = sizes.flute_length or sizes.length
    if 0.0 < flutes < step.step_down:
        table.add_problem(
            "step_down_mm", Wording("IMP312", "flutes_tool_mm", step_down=step.step_down, tool=step.tool, flutes=flutes)
        )
    if step.kind is StepKind.STOCK_ROUGHING and step.stepover.distance > sizes.diameter:
        table.add_problem(
            "stepover_mm",
            Wording("IMP312", "tool_mm_wide", distance=step.stepover.distance, tool=step.tool, diameter=sizes.diameter),
        )


def _read_stepover(table: Table) -> Stepover:
    if ("stepover_mm" in table) == ("scallop_mm" in table):
        table.add_problem("", Wording("IMP312", "needs_either_stepover"))
        table.mark_read("stepover_mm", "scallop_mm")
        return Stepover(distance=1.0)
    if "stepover_mm" in table:
        return Stepover(distance=table.number("stepover_mm", at_least=_LEAST, at_most=_GREATEST))
    return Stepover(scallop=table.number("scallop_mm", at_least=1e-5, at_most=1.0))


def _read_hub_allowance(table: Table, kind: StepKind) -> float:
    if kind in (StepKind.CHANNEL_ROUGHING, StepKind.HUB_FINISH):
        return table.number("hub_allowance_mm", 0.0, at_least=0.0, at_most=_GREATEST)
    return 0.0


def _read_tilt(table: Table, kind: StepKind) -> float:
    if kind is StepKind.STOCK_FINISHING:
        return table.number("tilt_deg", 0.0, at_least=0.0, at_most=90.0)
    if kind in (StepKind.STOCK_ROUGHING, StepKind.FLANK_MILLING):
        return 0.0
    return table.number("tilt_deg", _TILT, at_least=1.0, at_most=180.0)


def _read_overcut(table: Table, kind: StepKind) -> float:
    return table.number("overcut_mm", 0.01, at_least=0.001, at_most=1.0) if kind is StepKind.FLANK_MILLING else 0.0


def _read_clearance(table: Table) -> tuple[float, float, float, float]:
    """Of cutter, shank and holder, and of links from the stock."""
    keys = {"cutter_clearance_mm": 0.1, "shank_clearance_mm": 0.3, "holder_clearance_mm": 1.0, "link_clearance_mm": 2.0}
    cutter, shank, holder, link = (table.number(key, value, at_least=0.0, at_most=100.0) for key, value in keys.items())
    return cutter, shank, holder, link
