"""Reports: a verification as an HTML file that works offline, or as JSON."""

from trunnion.reporting.write import render_report, write_refusal, write_report

__all__ = ["render_report", "write_refusal", "write_report"]
