"""Results as plain data: each record says by its fields how it stands in JSON, and ``to_data`` makes it.

In:     records (dataclasses) whose fields and properties have a ``Figure`` where their data is not what they are.
Out:    dictionaries, lists, texts and numbers, as ``json`` takes them.
"""

from trunnion.results.data import as_json, to_data
from trunnion.results.figures import EXACT, FIRST, NOT_DATA, Figure, KeyFigure, figures_of
from trunnion.results.kinds import BlockNumber, CubicMillimetres, Degrees, Millimetres, OptionalLine, OptionalText

__all__ = [
    "EXACT",
    "FIRST",
    "NOT_DATA",
    "BlockNumber",
    "CubicMillimetres",
    "Degrees",
    "Figure",
    "KeyFigure",
    "Millimetres",
    "OptionalLine",
    "OptionalText",
    "as_json",
    "figures_of",
    "to_data",
]
