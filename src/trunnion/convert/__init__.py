"""Programs back into toolpaths: what the reader found out about an NC program becomes a ``Toolpath`` again."""

from trunnion.convert.program import Converted, convert
from trunnion.convert.settings import carried_over

__all__ = ["Converted", "carried_over", "convert"]
