"""Definitions to start from where no shipped machine has the same order of axes."""

from typing import Final

from trunnion.builder.document import with_value
from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, Problem
from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.records import dataclass
from trunnion.schemas import first_line


@dataclass(frozen=True, slots=True)
class Chain:
    """An order of axes from the workpiece to the tool: names, ``|`` for the bed, and the lines of rotary axes.

    order     such as ``C B X Y | Z``
    lines     direction of each rotary axis
    """

    order: str
    lines: tuple[tuple[str, tuple[float, float, float]], ...]


_A, _B, _C = ("A", (1.0, 0.0, 0.0)), ("B", (0.0, 1.0, 0.0)), ("C", (0.0, 0.0, 1.0))

#: By name. Nutated axes are these with another direction.
CHAINS: Final = {
    "table_table_ac": Chain("C A | X Y Z", (_A, _C)),
    "table_table_bc": Chain("C B X Y | Z", (_B, _C)),
    "head_table_bc": Chain("C | X Y Z B", (_B, _C)),
    "head_table_ac": Chain("C X | Y Z A", (_A, _C)),
    "head_head_ca": Chain("X | Y Z C A", (_A, _C)),
    "head_head_cb": Chain("| X Y Z C B", (_B, _C)),
    "table_a": Chain("A X Y | Z", (_A,)),
    "table_b": Chain("B X Y | Z", (_B,)),
    "table_c": Chain("C X Y | Z", (_C,)),
    "three_axis": Chain("X Y | Z", ()),
}

_SLIDES: Final = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}


def chain_text(chain: str, name: str, control: str, words: Words = LIBRARY) -> str:
    """Return a whole definition with an order of axes; what only the machine can tell is left out or marked.

    chain    a name of ``CHAINS``
    name     of the machine
    control  a shipped control
    words    of who measures: comments are in their language

    Raises ``InputError`` if there is no such chain.
    """
    if chain not in CHAINS:
        near = meant_word(chain, CHAINS)
        wording = (
            Wording("PAG210", "no_chain_but_near", chain=chain, near=near)
            if near
            else Wording("PAG210", "no_chain", chain=chain, known=tuple(CHAINS))
        )
        raise InputError(Problem("the builder", 0, wording))
    part, _, tool = CHAINS[chain].order.partition("|")
    carried = [(axis, "part") for axis in part.split()] + [(axis, "tool") for axis in tool.split()]
    tables = [_axis_table(axis, side, dict(CHAINS[chain].lines), words) for axis, side in carried]
    head = f'schema = 1\n\n[control]\nextends = "{control}"\n\n[spindle]\ndirection = [0, 0, 1]\n'
    return with_value(first_line("machine") + head + "\n" + "\n".join(tables), ("name",), name)


def _axis_table(axis: str, side: str, lines: dict[str, tuple[float, float, float]], words: Words) -> str:
    rotary = axis in lines
    x, y, z = lines[axis] if rotary else _SLIDES[axis]
    kind = "rotary" if rotary else "linear"
    text = f'[[axis]]\nname = "{axis}"\nkind = "{kind}"\ncarries = "{side}"\ndirection = [{x:g}, {y:g}, {z:g}]\n'
    if not rotary:
        return text  # travel that is not known is not checked, and programs warn of it
    point, limits = (phrase(what).text("what", words) for what in ("measure_point", "enter_limits"))
    text += f"point_mm = [0, 0, 0] # measure: {point}\n"
    if axis == "C":
        return text + 'endless = true\noutput = "0..360"\n'
    return text + f"limits_deg = [-110, 110] # enter: {limits}\n"
