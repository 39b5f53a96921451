"""The machining method of an operation, as its CL data tells: roughing, semi-finishing or finishing."""

from typing import Final

#: Parts of names, in capitals; the first that occurs decides.
_METHODS: Final = ("ROUGH", "SEMI", "FINISH")

#: INTOL + OUTTOL above this are those of roughing, whatever the name of the operation, mm; up to the others those of
#: semi-finishing and of finishing. The published programs rough with 0.06, also the operation BLADE_FINISH.
_ROUGHING_TOLERANCE: Final = 0.03
_FINISHING_TOLERANCE: Final = 0.01

_SLACK: Final = 1e-9


def machining_method(name: str, intol: float | None, outtol: float | None) -> str:
    """Return ROUGH, SEMI or FINISH: by tolerances if they are coarse, by the name, by tolerances, else ROUGH.

    Parameters
    ----------
    name
        Of the operation.
    intol, outtol
        Its tolerances, mm; None: it has none.

    Examples
    --------
    >>> machining_method("BLADE_FINISH", 0.03, 0.03), machining_method("BLADE_FINISH", 0.01, 0.01)
    ('ROUGH', 'FINISH')
    """
    tolerance = None if intol is None or outtol is None else intol + outtol
    if tolerance is not None and tolerance > _ROUGHING_TOLERANCE + _SLACK:
        return "ROUGH"
    for method in _METHODS:
        if method in name.upper():
            return method
    if tolerance is None:
        return "ROUGH"
    return "FINISH" if tolerance <= _FINISHING_TOLERANCE + _SLACK else "SEMI"
