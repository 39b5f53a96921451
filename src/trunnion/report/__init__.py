"""Reports: a verification as one HTML file that works offline, or as JSON."""

from trunnion.report.facts import Decided
from trunnion.report.write import write_report

__all__ = ["Decided", "write_report"]
