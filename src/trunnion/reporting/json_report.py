"""A report as JSON: the content of the page as data. docs/report.md has the schema.

In:     ``ReportContent`` and ``PlotSeries``.
Out:    UTF-8 JSON, with null for NaN and infinities.
"""

import json
from collections.abc import Iterator, Sequence

import numpy as np

from trunnion.model.clamping import clamping_data
from trunnion.model.motion import Decision
from trunnion.reporting.content import ReportContent
from trunnion.reporting.extents import AxisExtent, BlockReference, Extremes, TipExtent
from trunnion.reporting.plot_series import PlotSeries
from trunnion.reporting.recorded_content import RecordedContent
from trunnion.reporting.text import finite_or_none
from trunnion.reporting.usage import OperationUsage, ToolUsage
from trunnion.verification.results import Check, Place

#: Version of the schema. It rises when programs that read older files would be misled.
SCHEMA = 1

#: Programs with more motions get no columns: so much JSON is of no use.
MAX_COLUMN_MOTIONS = 100_000

#: Decimals of columns: finer than any control prints.
DECIMALS = 6


def render_json(content: ReportContent, series: PlotSeries) -> Iterator[bytes]:
    """Yield the document, piece by piece."""
    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False, indent=1)
    head = encoder.encode(_head(content)).removesuffix("\n}")
    yield head.encode()
    if content.motions > MAX_COLUMN_MOTIONS:
        note = f"{content.motions} motions; columns are written for up to {MAX_COLUMN_MOTIONS}"
        yield f',\n "columns": null,\n "columns_left_out": {json.dumps(note)}\n}}\n'.encode()
        return
    yield b',\n "columns": {'
    for k, (name, column) in enumerate(_columns(content, series)):
        values = json.dumps(column, allow_nan=False, separators=(",", ":"))
        yield f"{',' if k else ''}\n  {json.dumps(name, ensure_ascii=False)}: {values}".encode()
    yield b'\n },\n "columns_left_out": null\n}\n'


def _head(content: ReportContent) -> dict[str, object]:
    return {
        "schema": SCHEMA,
        "program": content.program,
        "machine": {"key": content.machine_key, "name": content.machine},
        "control": content.control or None,
        "made": content.made or None,
        "program_units": list(content.units),
        **clamping_data(content.clamping),
        "passed": content.passed,
        "checks": [_check(check) for check in content.checks],
        "motions": content.motions,
        "time": {
            "seconds": content.seconds,
            "cutting_seconds": content.cutting_seconds,
            "rapid_seconds": content.rapid_seconds,
            "waiting_seconds": content.waiting_seconds,
            "motions_without_time": content.untimed,
        },
        "tools": [_tool(tool) for tool in content.tools],
        "operations": [_operation(operation) for operation in content.operations],
        **({} if content.simulation is None else {"simulation": dict(content.simulation.data)}),
        **({} if content.recorded is None else {"recorded": _recorded(content.recorded)}),
        "decisions": [_decision(decision) for decision in content.decisions],
        "extents": {
            "tip": [_tip(extent) for extent in content.tip],
            "axes": [_axis(extent) for extent in content.axes],
        },
    }


def _recorded(recorded: RecordedContent) -> dict[str, object]:
    return {
        "file": recorded.file,
        "seconds": recorded.seconds,
        "positions": recorded.compared,
        "positions_elsewhere": recorded.other,
        "incomplete_rows": recorded.incomplete,
        "gaps": recorded.gaps,
        "extents": [_axis(extent) for extent in recorded.extents],
    }


def _check(check: Check) -> dict[str, object]:
    return {
        "key": check.key,
        "title": check.title,
        "passed": check.passed,
        "summary": check.summary,
        "worst": finite_or_none(check.worst),
        "limit": finite_or_none(check.limit),
        "unit": check.unit,
        "places": [_place(place) for place in check.places],
    }


def _place(place: Place) -> dict[str, object]:
    return {
        "nc_line": place.nc_line,
        "nc_file": place.nc_file or None,
        "number": _number(place.number),
        "cl_file": place.cl_file or None,
        "cl_line": place.cl_line or None,
        "value": finite_or_none(place.value),
        "text": place.text,
        "code": place.code or None,
    }


def _tool(tool: ToolUsage) -> dict[str, object]:
    return {
        "name": tool.name,
        "motions": tool.motions,
        "seconds": tool.seconds,
        "cutting_seconds": tool.cutting_seconds,
        "rapid_seconds": tool.rapid_seconds,
        "rpm": list(tool.rpm) if tool.rpm else None,
        "feed": list(tool.feed) if tool.feed else None,
        "first": _block(tool.first),
    }


def _operation(operation: OperationUsage) -> dict[str, object]:
    return {
        "name": operation.name,
        "tool": operation.tool,
        "cl_file": operation.cl_file or None,
        "motions": operation.motions,
        "seconds": operation.seconds,
        "cutting_seconds": operation.cutting_seconds,
        "rapid_seconds": operation.rapid_seconds,
        "first": _block(operation.first) if operation.first else None,
    }


def _decision(decision: Decision) -> dict[str, object]:
    return {
        "operation": decision.operation,
        "cl_file": decision.file or None,
        "cl_line": decision.line or None,
        "about": decision.topic,
        "text": decision.text,
    }


def _tip(extent: TipExtent) -> dict[str, object]:
    return {"name": extent.name, "unit": "mm", "whole": _extremes(extent.whole), "cutting": _extremes(extent.cutting)}


def _axis(extent: AxisExtent) -> dict[str, object]:
    return {
        "name": extent.name,
        "unit": "deg" if extent.unit == "°" else extent.unit,
        "whole": _extremes(extent.extremes),
        "limits": [extent.low_limit, extent.high_limit],
        "endless": extent.endless,
        "placed": extent.zero_known,
        "margin": extent.margin,
    }


def _extremes(extremes: Extremes | None) -> dict[str, object] | None:
    if extremes is None:
        return None
    return {
        "low": extremes.low,
        "high": extremes.high,
        "low_at": _block(extremes.low_at),
        "high_at": _block(extremes.high_at),
    }


def _block(block: BlockReference) -> dict[str, object]:
    return {"nc_line": block.nc_line, "number": _number(block.number), "nc_file": block.file or None}


def _number(number: int) -> int | None:
    return number if number >= 0 else None


def _columns(content: ReportContent, series: PlotSeries) -> Iterator[tuple[str, Sequence[float | str | None]]]:
    """Yield the columns by the names of the schema, one value a motion: without the point before the first one."""
    yield "nc_line", series.lines["block"][1:].tolist()
    yield "number", series.lines["number"][1:].tolist()
    yield "cl_line", series.lines["cl"][1:].tolist()
    if "file" in series.lines:
        yield "nc_file", [series.files[file] for file in series.lines["file"][1:]]
    if series.timed:
        yield "time", np.round(series.time()[1:], DECIMALS).tolist()
    for k, axis in enumerate(content.axes):
        yield f"axis {axis.name}", _rounded(series, f"axis{k}")
    for k, axis in enumerate(content.axes):
        if f"speed{k}" in series.values:
            yield f"speed {axis.name}", _rounded(series, f"speed{k}")
    yield "tip_feed", _rounded(series, "feed")
    if content.recorded is not None:
        yield "recorded_positions", content.recorded.positions.tolist()
        for k, name in enumerate(("recorded_tip_off", "recorded_axis_off")):
            yield name, [None if np.isnan(value) else value for value in content.recorded.worst[:, k].tolist()]


def _rounded(series: PlotSeries, column: str) -> list[float]:
    values: list[float] = np.round(series.values[column][1:].astype(np.float64), DECIMALS).tolist()
    return values
