"""Programs back into toolpaths: what the reader found out about an NC program becomes a ``Toolpath`` again."""

from trunnion.conversion.settings import transfer_settings
from trunnion.conversion.toolpath_builder import Conversion, convert

__all__ = ["Conversion", "convert", "transfer_settings"]
