"""A report as JSON: what the page says, as data. The schema stands in docs/report.md.

In:     ``Facts`` and ``Series``.
Out:    UTF-8 JSON, without NaN and infinities (null instead).
"""

import json
from collections.abc import Iterator

import numpy as np

from trunnion.reporting.facts import AxisExtent, Decided, Facts, OperationUse, Span, Spot, TipExtent, ToolUse, finite
from trunnion.reporting.series import Series
from trunnion.verification.results import Check, Place

#: Version of the schema; it grows when a reader of older files would be misled.
SCHEMA = 1

#: Programs with more motions get no columns: as JSON they would be of no use to anybody.
COLUMNS_UP_TO = 100_000

#: Decimals of columns: finer than any control prints.
DECIMALS = 6


def data(said: Facts, shown: Series) -> Iterator[bytes]:
    """Yield the document, piece by piece."""
    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False, indent=1)
    head = encoder.encode(_head(said)).removesuffix("\n}")
    yield head.encode()
    if said.motions > COLUMNS_UP_TO:
        note = f"{said.motions} motions; columns are written for up to {COLUMNS_UP_TO}"
        yield f',\n "columns": null,\n "columns_left_out": {json.dumps(note)}\n}}\n'.encode()
        return
    yield b',\n "columns": {'
    for k, (name, column) in enumerate(_columns(said, shown)):
        values = json.dumps(column, allow_nan=False, separators=(",", ":"))
        yield f"{',' if k else ''}\n  {json.dumps(name, ensure_ascii=False)}: {values}".encode()
    yield b'\n },\n "columns_left_out": null\n}\n'


def _head(said: Facts) -> dict[str, object]:
    return {
        "schema": SCHEMA,
        "program": said.program,
        "machine": {"key": said.machine_key, "name": said.machine},
        "control": said.control or None,
        "made": said.made or None,
        "passed": said.passed,
        "checks": [_check(check) for check in said.checks],
        "motions": said.motions,
        "time": {
            "seconds": said.seconds,
            "cutting_seconds": said.cutting_seconds,
            "rapid_seconds": said.rapid_seconds,
            "motions_without_time": said.untimed,
        },
        "tools": [_tool(tool) for tool in said.tools],
        "operations": [_operation(operation) for operation in said.operations],
        "decisions": [_decided(decided) for decided in said.decisions],
        "extents": {
            "tip": [_tip(extent) for extent in said.tip],
            "axes": [_axis(extent) for extent in said.axes],
        },
    }


def _check(check: Check) -> dict[str, object]:
    return {
        "key": check.key,
        "title": check.title,
        "passed": check.passed,
        "summary": check.summary,
        "worst": finite(check.worst),
        "limit": finite(check.limit),
        "unit": check.unit,
        "places": [_place(place) for place in check.places],
    }


def _place(place: Place) -> dict[str, object]:
    return {
        "nc_line": place.nc_line,
        "number": _number(place.number),
        "cl_file": place.cl_file or None,
        "cl_line": place.cl_line or None,
        "value": finite(place.value),
        "text": place.text,
    }


def _tool(tool: ToolUse) -> dict[str, object]:
    return {
        "name": tool.name,
        "motions": tool.motions,
        "seconds": tool.seconds,
        "cutting_seconds": tool.cutting_seconds,
        "rapid_seconds": tool.rapid_seconds,
        "rpm": list(tool.rpm) if tool.rpm else None,
        "feed": list(tool.feed) if tool.feed else None,
        "first": _spot(tool.first),
    }


def _operation(operation: OperationUse) -> dict[str, object]:
    return {
        "name": operation.name,
        "tool": operation.tool,
        "cl_file": operation.cl_file or None,
        "motions": operation.motions,
        "seconds": operation.seconds,
        "cutting_seconds": operation.cutting_seconds,
        "rapid_seconds": operation.rapid_seconds,
        "first": _spot(operation.first) if operation.first else None,
    }


def _decided(decided: Decided) -> dict[str, object]:
    return {
        "operation": decided.operation,
        "cl_file": decided.cl_file or None,
        "cl_line": decided.cl_line or None,
        "about": decided.about,
        "text": decided.text,
    }


def _tip(extent: TipExtent) -> dict[str, object]:
    return {"name": extent.name, "unit": "mm", "whole": _span(extent.whole), "cutting": _span(extent.cutting)}


def _axis(extent: AxisExtent) -> dict[str, object]:
    return {
        "name": extent.name,
        "unit": "deg" if extent.unit == "°" else extent.unit,
        "whole": _span(extent.span),
        "limits": [extent.low_limit, extent.high_limit],
        "endless": extent.endless,
        "placed": extent.placed,
        "margin": extent.margin,
    }


def _span(span: Span | None) -> dict[str, object] | None:
    if span is None:
        return None
    return {"low": span.low, "high": span.high, "low_at": _spot(span.low_at), "high_at": _spot(span.high_at)}


def _spot(spot: Spot) -> dict[str, object]:
    return {"nc_line": spot.nc_line, "number": _number(spot.number), "nc_file": spot.file or None}


def _number(number: int) -> int | None:
    return number if number >= 0 else None


def _columns(said: Facts, shown: Series) -> Iterator[tuple[str, list[float] | list[int] | list[str]]]:
    """Yield the columns under the names that the schema gives them; one value a motion, so without the first point."""
    yield "nc_line", shown.lines["block"][1:].tolist()
    yield "number", shown.lines["number"][1:].tolist()
    yield "cl_line", shown.lines["cl"][1:].tolist()
    if "file" in shown.lines:
        yield "nc_file", [shown.files[file] for file in shown.lines["file"][1:]]
    if shown.timed:
        yield "time", np.round(shown.time()[1:], DECIMALS).tolist()
    names = [f"axis {axis.name}" for axis in said.axes]
    for k, name in enumerate(names):
        yield name, np.round(shown.values[f"axis{k}"][1:].astype(np.float64), DECIMALS).tolist()
    for k, axis in enumerate(said.axes):
        if f"speed{k}" in shown.values:
            speeds = shown.values[f"speed{k}"][1:].astype(np.float64)
            yield f"speed {axis.name}", np.round(speeds, DECIMALS).tolist()
    yield "tip_feed", np.round(shown.values["feed"][1:].astype(np.float64), DECIMALS).tolist()
