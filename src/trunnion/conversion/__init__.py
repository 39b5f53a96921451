"""Programs back into toolpaths: what the reader found out about an NC program becomes a ``Toolpath`` again."""

from trunnion.conversion.settings import carried_over
from trunnion.conversion.toolpath_builder import Converted, convert

__all__ = ["Converted", "carried_over", "convert"]
