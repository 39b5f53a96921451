"""Definitions of Klartext's drilling cycles as text."""

from trunnion.readers.families.heidenhain.words import CYCLE_OPTIONS, CYCLE_PARAMETERS

BEFORE = "TOOL CALL 1 Z S1000\nL X+3 Y+4 Z+100 R0 FMAX M3\n"


def define(number: int, **values: float) -> str:
    """A definition, one parameter a line; those of other cycles are left out."""
    if number in CYCLE_PARAMETERS:
        own = {f"Q{each}" for each in (*CYCLE_PARAMETERS[number], *CYCLE_OPTIONS.get(number, ()))}
        values = {name: value for name, value in values.items() if name in own}
    return f"CYCL DEF {number} NAME ~\n" + " ~\n".join(f"{name}={value:+g}" for name, value in values.items()) + "\n"


DRILL: dict[str, float] = {"Q200": 2, "Q201": -15, "Q206": 150, "Q202": 6, "Q210": 0, "Q203": 10, "Q204": 50, "Q211": 0}
