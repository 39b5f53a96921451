"""``trunnion curve``: curves through measured points."""

from collections.abc import Iterator

from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.geometry.fitting import CurveFit
from trunnion.jobs.impeller.curves import fit_curve, read_points, write_curve_picture
from trunnion.jobs.job import Given
from trunnion.wording import counted


def run(given: Given) -> int:
    """Fit curves, print and draw them."""
    tables = read_points(given.file, scale=given.scale)
    fits = [fit_curve(table, **given.arguments("file")) for table in tables]
    Terminal().problems([remark for one in fits for remark in one.remarks])
    if given.picture is not None:
        write_curve_picture(fits, given.picture, inputs=given.read)
    show(given, lambda: {"schema": 2, "curves": fits}, curve_lines(fits))
    return 0


def curve_lines(fits: list[CurveFit]) -> Iterator[str]:
    """Curves in lines."""
    for one in fits:
        curve = one.curve
        yield f"{one.name or 'curve'}: {counted(len(one.points), 'point')}, {one.length:.3f} mm long"
        yield f"  control points ({len(curve.control_points)})"
        for k, (x, y, z) in enumerate(curve.control_points, 1):
            yield f"  {k:5d} {x:12.4f} {y:12.4f} {z:12.4f}"
        yield f"  knots ({len(curve.knots)}): {' '.join(f'{knot:.6f}' for knot in curve.knots)}"
        yield "  point    off mm   then: length mm      sag mm    radius mm   turn deg  off natural ends mm"
        for k, off in enumerate(one.offsets):
            line = f"  {k + 1:5d} {off:9.6f}"
            if k < len(one.spans):
                span = one.spans[k]
                line += f" {span.length:16.4f} {span.sag:11.5f} {span.radius:12.5g} {span.turn:10.2f} {span.bend:20.5f}"
            yield line
        worst = max(one.spans, key=lambda span: span.bend)
        yield (
            f"  points are at most {one.offsets.max():.6f} mm off, {(one.offsets**2).mean() ** 0.5:.6f} rms;"
            f" natural ends would move the curve by up to {worst.bend:.5f} mm"
        )
