"""``trunnion curve``: curves through measured points."""

from collections.abc import Iterator
from typing import Final

from trunnion.cli.columns import padded
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import line, part, spoken
from trunnion.geometry.fitting import CurveFit
from trunnion.jobs.impeller.curves import fit_curve, read_points, write_curve_picture
from trunnion.jobs.job import Given

#: Columns of the table of points, and their widths.
_HEADS: Final = (
    ("point", 7), ("off", 10), ("length", 18), ("sag", 12), ("radius", 13), ("turn", 11), ("bend", 21),
)  # fmt: skip


def run(given: Given) -> int:
    """Fit curves, print and draw them."""
    tables = read_points(given.file, scale=given.scale)
    fits = [fit_curve(table, **given.arguments("file")) for table in tables]
    Terminal().problems([remark for one in fits for remark in one.remarks])
    if given.picture is not None:
        write_curve_picture(fits, given.picture, inputs=given.read, words=spoken())
    show(given, lambda: {"schema": 2, "curves": fits}, curve_lines(fits))
    return 0


def curve_lines(fits: list[CurveFit]) -> Iterator[str]:
    """Curves in lines."""
    for one in fits:
        curve = one.curve
        yield line("curve_points", name=one.name or part("curve"), count=len(one.points), length=one.length)
        yield "  " + line("control_points", count=len(curve.control_points))
        for k, (x, y, z) in enumerate(curve.control_points, 1):
            yield f"  {k:5d} {x:12.4f} {y:12.4f} {z:12.4f}"
        knots = " ".join(f"{knot:.6f}" for knot in curve.knots)
        yield "  " + line("knots", count=len(curve.knots), knots=knots)
        yield "".join(padded(line(f"head_{head}"), width, right=True) for head, width in _HEADS)
        for k, off in enumerate(one.offsets):
            row = f"  {k + 1:5d} {off:9.6f}"
            if k < len(one.spans):
                span = one.spans[k]
                row += f" {span.length:16.4f} {span.sag:11.5f} {span.radius:12.5g} {span.turn:10.2f} {span.bend:20.5f}"
            yield row
        worst = max(one.spans, key=lambda span: span.bend)
        rms = (one.offsets**2).mean() ** 0.5
        yield "  " + line("curve_worst", most=one.offsets.max(), rms=rms, bend=worst.bend)
