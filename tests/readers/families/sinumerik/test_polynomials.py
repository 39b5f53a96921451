"""POLY: axes along polynomials, as the manual defines them."""

import numpy as np
import pytest
from hypothesis import given, settings

from tests.support.examples import examples
from tests.support.naive.splines import points_of, splines
from tests.support.reading import Runner, close
from trunnion.controls.words import NumberFormat
from trunnion.machines import Machine
from trunnion.model.run import ProgrammedWord
from trunnion.model.splines import Spline
from trunnion.model.toolpath import Kind
from trunnion.output.families.sinumerik.splines import spline_lines, takes_spline
from trunnion.readers import run_program

HEAD = "G17 G710 G90 G94\nG54 D1\nG1 X1 Y2 Z3 F500\n"


def test_the_coefficient_of_the_parameter_follows_from_the_end(run: Runner) -> None:
    found = run(f"{HEAD}POLY PO[X]=(4,0.5,-0.25) PO[Y]=(2,1) PL=2\nN7 Z1\nPO[Z]=(3)\nG1 X0\n")
    assert not found.diagnostics
    first, last, spline = found.splines[0]
    assert (first, len(found.splines)) == (1, 2)
    p = np.linspace(0.0, 2.0, 9)
    # a1 of X: (4 - 1 - 0.5 * 4 + 0.25 * 8) / 2; of Y: (0 - 1 * 4) / 2
    wanted = np.column_stack((1 + 1.5 * p + 0.5 * p**2 - 0.25 * p**3, 2 - 2 * p + p**2, 3 + 0 * p))
    close(points_of(spline, p), wanted, atol=1e-12)
    at = np.arange(1, last + 1) * 2.0 / last
    close(found.tip[1 : last + 1], points_of(spline, at), atol=1e-9)
    assert np.diff(found.tip[: last + 1, 1]).max() < 0.1
    close(found.tip[last + 1], [4, 2, 1])  # axes without a polynomial go straight there
    close(found.tip[-2:], [[4, 2, 3], [0, 2, 3]])
    assert set(found.kind.tolist()) == {Kind.LINEAR}
    assert found.lines[last] == 4
    assert found.programmed[1] == int(ProgrammedWord.X | ProgrammedWord.Y)


def test_inches_and_frames_move_the_curve(run: Runner) -> None:
    plain = run(f"{HEAD}POLY PO[X]=(11,4,-2) PO[Y]=(8,1)\n").splines[0].spline
    inches = run("G17 G700 G90 G94\nG54 D1\nG1 X1 Y2 Z3 F9\nPOLY PO[X]=(11,4,-2) PO[Y]=(8,1)\n").splines[0].spline
    close(inches.poles, plain.poles * 25.4, atol=1e-9)
    turned = run("G17 G710 G90\nG54 D1\nTRANS X5\nAROT Z90\nG1 X1 Y2 Z3 F9\nPOLY PO[X]=(11,4,-2) PO[Y]=(8,1)\n")
    close(turned.splines[0].spline.poles, plain.poles[:, [1, 0, 2]] * [-1, 1, 1] + [5, 0, 0], atol=1e-9)


@pytest.mark.parametrize(
    ("block", "named"),
    [
        ("PO[X]=(4,1)", "without POLY"),
        ("POLY PO[X]=(4,1) PO[]=(2,1)", "denominator"),
        ("POLY PO[X]=(4,1,2,3)", "more than 3 values"),
        ("POLY PO[B]=(4,1)", "only X, Y and Z"),
        ("POLY PO[X]=(4,1) X4", "X and PO[X]"),
        ("POLY PO[X]=(4,1) Y=IC(4)", "absolute"),
        ("G91 POLY PO[X]=(4,1)", "absolute"),
        ("POLY PO[X]=(4,1) PL=0", "PL=0"),
        ("POLY PL=2 X4", "without PO[]"),
        ("POLY X4 I2", "I in a block of POLY"),
        ("SUPA POLY PO[X]=(4,1)", "machine positions"),
        ("G41 POLY PO[X]=(4,1)", "radius compensation"),
        ("TRAORI\nPOLY PO[X]=(4,1)", "TRAORI"),
        ("POLY PO[X]=4", "parentheses"),
        ("POLY PO[X]=()", "an end and coefficients"),
        ("POLY PO[X]=(1,,2)", "an end and coefficients"),
        ("POLY PO[X]=(4,1) PO[X]=(4,1)", "an end and coefficients"),
        ("POLY PO[X]=(4,9E5,-9E5)", "not understood"),
        ("POLY PO[X]=(4,9000000) PL=9", "more than 10000 points"),
        ("POLY PO[X]=(99999999)", "no machine has"),
        ("BSPLINE X4 Y5 PL=2", "BSPLINE"),
        ('POLYPATH("AXES")', "POLYPATH"),
    ],
)
def test_what_is_not_certain_is_an_error(run: Runner, block: str, named: str) -> None:
    found = run(f"{HEAD}{block}\n")
    assert any(named in error.text for error in found.errors), found.diagnostics


@settings(max_examples=examples(15), deadline=None)
@given(splines(degrees=(2, 3), repeats=2))
def test_what_is_written_is_read(tmp_path_factory: pytest.TempPathFactory, yl569: Machine, spline: Spline) -> None:
    assert takes_spline(spline)
    lines = spline_lines(spline, {"coordinate": NumberFormat(3, zero="0.0")})
    x, y, z = spline.poles[0]
    path = tmp_path_factory.mktemp("poly") / "A.MPF"
    path.write_text(f"G17 G710 G90 G94\nG54 D1\nG1 X{x:.5f} Y{y:.5f} Z{z:.5f} F500\n" + "\n".join(lines))
    found = run_program(path, yl569)
    assert not found.errors
    assert len(found.splines) == len(spline.spans) == len(lines)
    for k, span in enumerate(spline.spans.tolist()):
        begin, end = spline.knots[span], spline.knots[span + 1]
        first, last, own = found.splines[k]
        at = np.linspace(0.0, 1.0, last - first + 2)[1:]
        close(found.tip[first : last + 1], points_of(spline, begin + (end - begin) * at), atol=3e-5)
        dense = np.linspace(0.0, 1.0, 9)
        close(points_of(own, dense), points_of(spline, begin + (end - begin) * dense), atol=3e-5)
        chords = np.concatenate((found.tip[first - 1 : first], found.tip[first : last + 1]))
        middle = points_of(own, np.linspace(0.0, 1.0, 2 * (last - first + 1) + 1)[1::2])
        assert np.linalg.norm(middle - 0.5 * (chords[:-1] + chords[1:]), axis=1).max() <= 0.001 + 1e-9
