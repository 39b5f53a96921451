"""Reports: a verification as an HTML file that works offline, or as JSON."""

from trunnion.reporting.write import write_refusal, write_report

__all__ = ["write_refusal", "write_report"]
