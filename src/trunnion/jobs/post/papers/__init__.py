"""What goes with a program: report, setup sheet, listing and manifest."""

from typing import Final

from trunnion.version import __version__

#: What made a paper.
MADE_BY: Final = f"Trunnion {__version__}"
