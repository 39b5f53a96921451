"""Reports: a verification as one HTML file that works offline, or as JSON."""

from trunnion.reporting.facts import Decided
from trunnion.reporting.write import write_report

__all__ = ["Decided", "write_report"]
