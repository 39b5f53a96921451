"""Reports: a verification as one HTML file that works offline, or as JSON."""

from trunnion.reporting.content import PlanDecision
from trunnion.reporting.write import write_report

__all__ = ["PlanDecision", "write_report"]
