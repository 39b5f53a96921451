"""A report as JSON: the content of the page as data. docs/report.md has the schema.

In:     ``ReportContent`` and ``PlotSeries``.
Out:    UTF-8 JSON, with null for NaN and infinities.
"""

import json
import math
from collections.abc import Iterator, Sequence

import numpy as np

from trunnion.messages import LIBRARY, Words
from trunnion.reporting.content import ReportContent
from trunnion.reporting.plot_series import PlotSeries
from trunnion.results import to_data

#: Programs with more motions get no columns: so much JSON is of no use.
MAX_COLUMN_MOTIONS = 100_000

#: Decimals of columns: finer than any control prints.
DECIMALS = 6


def render_json(content: ReportContent, series: PlotSeries, words: Words = LIBRARY) -> Iterator[bytes]:
    """Yield the document, piece by piece; it is the same whoever asks."""
    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False, indent=1)
    head = encoder.encode(to_data(content)).removesuffix("\n}")
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


def _rounded(series: PlotSeries, column: str) -> list[float | None]:
    """Return the values of a column, None where they are not known."""
    values: list[float] = np.round(series.values[column][1:].astype(np.float64), DECIMALS).tolist()
    return [None if math.isnan(value) else value for value in values]
