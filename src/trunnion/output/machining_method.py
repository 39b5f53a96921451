"""The machining method of an operation, as its CL data tells: roughing, semi-finishing or finishing."""

from typing import Final

from trunnion.model.toolpath import Operation

#: Parts of names, in capitals; the first that occurs decides.
_METHODS: Final = ("ROUGH", "SEMI", "FINISH")

#: INTOL + OUTTOL above this are those of roughing, whatever the name of the operation, mm; up to the others those of
#: semi-finishing and of finishing. The published programs rough with 0.06, also the operation BLADE_FINISH.
_ROUGHING_TOLERANCE: Final = 0.03
_FINISHING_TOLERANCE: Final = 0.01

_SLACK: Final = 1e-9


def machining_method(operation: Operation) -> str:
    """Return ROUGH, SEMI or FINISH: by tolerances if they are coarse, by names, by tolerances, else ROUGH.

    Examples
    --------
    >>> from trunnion import read_cl
    >>> machining_method(read_cl("tests/golden/yl569/3_blade_finish.cls").operations[0])
    'ROUGH'
    """
    tolerance = None
    if operation.intol is not None and operation.outtol is not None:
        tolerance = operation.intol + operation.outtol
        if tolerance > _ROUGHING_TOLERANCE + _SLACK:
            return "ROUGH"
    name = operation.name.upper()
    for method in _METHODS:
        if method in name:
            return method
    if tolerance is None:
        return "ROUGH"
    return "FINISH" if tolerance <= _FINISHING_TOLERANCE + _SLACK else "SEMI"
