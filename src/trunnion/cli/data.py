"""Results as data, of commands whose results nothing else makes data of."""

import io
import json
from typing import Any

from trunnion.definitions.source_lines import LocatedValue
from trunnion.jobs.verify.reports import add_report
from trunnion.verification import Verification


def report_data(verification: Verification) -> Any:
    """Return what a report of the verification has, as data (docs/report.md)."""
    sink = io.BytesIO()
    add_report(verification, sink, "report.json", ())
    return json.loads(sink.getvalue())


def plain_data(located: LocatedValue) -> Any:
    """Return the values of a definition, without their places."""
    value = located.value
    if isinstance(value, dict):
        return {key: plain_data(each) for key, each in value.items()}
    if isinstance(value, list):
        return [plain_data(each) if isinstance(each, LocatedValue) else each for each in value]
    return value
