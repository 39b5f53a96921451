"""Kinds of figures that many records have; each is the type of a field."""

from typing import Annotated

from trunnion.results.figures import Figure

#: A length whose key ends with ``mm``, and an angle, area and volume alike.
Millimetres = Annotated[float, Figure(unit="mm")]
Degrees = Annotated[float, Figure(unit="deg")]
CubicMillimetres = Annotated[float, Figure(unit="mm3")]

#: A text that is empty, a line that is 0, and a block number that is -1 where there is none.
OptionalText = Annotated[str, Figure(none="")]
OptionalLine = Annotated[int, Figure(none=0)]
BlockNumber = Annotated[int, Figure(none=-1)]
