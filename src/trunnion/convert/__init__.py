"""Programs back into toolpaths: what the reader found out about an NC program becomes a ``Toolpath`` again."""

from trunnion.convert.program import Converted, convert

__all__ = ["Converted", "convert"]
