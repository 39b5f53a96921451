"""Drilling cycles, motion by motion."""

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.families.sinumerik.cycles import peck_depths


def heights(result: Run, kind: Kind | None = None) -> list[float]:
    """Z of the rows, or of those of a kind."""
    z = result.tip[:, 2]
    return [float(height) for height in (z if kind is None else z[result.kind == kind])]


HEAD = "G0 X0 Y0 Z50 S1000 M3\nF180\n"


def test_a_modal_cycle_drills_at_every_position_until_it_ends(run: Runner) -> None:
    result = run(HEAD + "MCALL CYCLE81(10,0,3,-6)\nX10 Y10\nX40\nMCALL\nX50")
    assert result.diagnostics == ()
    close(
        result.tip[1:],
        [
            [10, 10, 50], [10, 10, 3], [10, 10, -6], [10, 10, 10],
            [40, 10, 10], [40, 10, 3], [40, 10, -6], [40, 10, 10],
            [50, 10, 10],
        ],
    )  # fmt: skip
    assert result.line[1:].tolist() == [4, 4, 4, 4, 5, 5, 5, 5, 7]
    assert result.kind[1:5].tolist() == [Kind.RAPID, Kind.RAPID, Kind.LINEAR, Kind.RAPID]
    assert result.programmed[2:5].tolist() == [0, 0, 0]
    assert result.feed[3] == 180.0


def test_a_cycle_without_mcall_drills_once_where_the_tool_is(run: Runner) -> None:
    assert heights(run(HEAD + "CYCLE82(10,0,3,,6,0.5)\nX1")) == [50, 3, -6, 10, 10]
    assert [e.value for e in run(HEAD + "CYCLE82(10,0,3,,6,0.5)").events if e.kind == "dwell"] == [0.5]


def test_pecking_with_full_retraction(run: Runner) -> None:
    # The facts' example: first peck 6, then 1 less each time but not less than 2; chips are cleared at Z2.
    result = run(HEAD + "CYCLE83(50,0,2,-20,,-6,,1,0.2,0,1,1,3,2,,0,1)")
    assert result.diagnostics == ()
    bottoms = heights(result, Kind.LINEAR)
    assert bottoms == [-6, -11, -15, -18, -20]
    assert heights(result)[1:6] == [2, -6, 2, -5, -11]
    assert heights(result)[-1] == 50


def test_pecking_with_chip_breaking(run: Runner) -> None:
    result = run(HEAD + "CYCLE83(50,0,2,-15,,,5,0,0,0,0.5,0,3,0,0.5)")
    assert heights(result) == [50, 2, -5, -4.5, -10, -9.5, -15, 50]
    assert result.feed[2] == 90.0
    assert result.feed[4] == 180.0


def test_pecks_of_deep_holes() -> None:
    assert peck_depths(10, 10, 0, 0) == [10]
    assert peck_depths(10, 4, 0, 0) == [4, 8, 10]
    assert peck_depths(20, 8, -0.5, 2) == [8, 12, 14, 16, 18, 20]
    with pytest.raises(CycleExecutionError, match="more than"):
        peck_depths(10, 0.001, 0, 0)
    with pytest.raises(CycleExecutionError, match="above"):
        peck_depths(10, -1, 0, 0)


def test_tapping_goes_at_the_pitch(run: Runner) -> None:
    result = run(HEAD + "CYCLE84(20,0,3,-15,,0.1,3,,1.25,0,600,800)")
    assert heights(result) == [50, 3, -15, 3, 20]
    assert result.feed[2:4].tolist() == [750.0, 1000.0]
    assert result.kind[3] == Kind.LINEAR
    assert run(HEAD + "CYCLE84(20,0,3,-15,,,3,8,,,1000)").feed[2] == 1250.0
    assert run(HEAD + "CYCLE840(20,0,3,-15,,,0,3,0,,1.5)").feed[2] == 1500.0
    assert "no pitch" in run(HEAD + "CYCLE84(20,0,3,-15,,,3,,,,600)").errors[0].text


def test_reaming_and_boring(run: Runner) -> None:
    ream = run(HEAD + "CYCLE85(20,0,3,-15,,0,100,400)")
    assert heights(ream) == [50, 3, -15, 3, 20]
    assert ream.feed[2:4].tolist() == [100.0, 400.0]
    bore = run(HEAD + "CYCLE86(20,0,3,-15,,0,3,0.2,-0.1,0.5,90)")
    close(bore.tip[1:], [[0, 0, 3], [0, 0, -15], [0.2, -0.1, -14.5], [0.2, -0.1, 3], [0, 0, 20]])
    assert heights(run(HEAD + "CYCLE89(20,0,3,-15)")) == [50, 3, -15, 3, 20]


def test_cycles_drill_along_the_frame(run: Runner) -> None:
    tilted = run("G0 B90\nTRAORI\nROT Y90\nX1 Y2 Z50\nCYCLE81(10,0,3,-6)")
    assert tilted.diagnostics == ()
    close(tilted.tip[-2], [-6, 2, -1], atol=1e-9)
    askew = run("TRAORI\nROT Y90\nX1 Y2 Z50\nCYCLE81(10,0,3,-6)")
    assert "not the tool axis" in askew.diagnostics[0].text
    side = run("G19 G0 X50\nCYCLE81(10,0,3,-6)")
    assert side.tip[:, 0].tolist() == [50, 3, -6, 10]


def test_a_subprogram_may_be_modal(run: Runner) -> None:
    result = run("MCALL L7\nX10\nX20\nMCALL\nX30", files={"L7.SPF": "Z=IC(-1)\nZ=IC(1)\nRET"})
    assert result.tip[:, 0].tolist() == [10, 10, 10, 20, 20, 20, 30]
    assert result.file.tolist() == [0, 1, 1, 0, 1, 1, 0]


@pytest.mark.parametrize(
    "cycle",
    [
        *("CYCLE81(10,20,3,-6)", "CYCLE81(10,0,3)", "CYCLE81(,0,3,-6)", 'CYCLE81("A",0,3,-6)', "CYCLE81(9,9,0,9)"),
        *("CYCLE84(9,0,2,-9,,,3,,1EX300)", "CYCLE84(9,0,2,-9,,,3,,1EX-300,,,,,2)"),
    ],
)
def test_cycles_that_make_no_sense_are_named(run: Runner, cycle: str) -> None:
    result = run(HEAD + cycle)
    assert len(result) == 1
    assert "not executed" in result.errors[0].text


@pytest.mark.parametrize(
    ("call", "missing"),
    [
        ("CYCLE83(10,0,3,-15)", "FDEP or FDPR"),
        ("CYCLE84(10,0,3,-6,,,,,1.25,0,600,600)", "SDAC"),
        ("CYCLE84(10,0,3,-6,,,3,,1.25)", "SST"),
        ("CYCLE85(10,0,3,-6)", "FFR"),
        ("CYCLE85(10,0,3,-6,,,100)", "RFF"),
        ("CYCLE86(10,0,3,-6)", "SDIR"),
        ("CYCLE87(10,0,3,-6)", "SDIR"),
        ("CYCLE88(10,0,3,-6,,0.5)", "SDIR"),
    ],
)
def test_values_that_are_not_0_when_they_are_left_out(call: str, missing: str, run: Runner) -> None:
    """The language takes values that a call leaves out as 0, which is no depth, feed, speed or sense."""
    found = run(HEAD + call)
    assert len(found) == 1
    assert missing in found.errors[0].text


#: Call -> motions at a hole as (R or F, height), and dwells; the tool stands at Z50 and the spindle turns with 1000.
CALLS = {
    "CYCLE81(10,0,3,-6)": ("R3 F-6 R10", []),
    "CYCLE81(10,0,3,,6)": ("R3 F-6 R10", []),
    "CYCLE82(10,0,3,-6,,0.5)": ("R3 F-6 R10", [0.5]),
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,0.5,2)": ("R3 F-5 F-4.5 F-10 F-9.5 F-15 R10", [2.0]),
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,1,3,0,0,2,1)": ("R3 F-5 R3 R-4 F-10 R3 R-9 F-15 R10", [2.0]),
    "CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600)": ("R3 F-6 F3 R10", [0.5]),
    "CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600,3,1,0,1,2.5,1)": ("R3 F-2.5 F-1.5 F-5 F-4 F-6 F3 R10", [0.5]),
    "CYCLE84(10,0,3,-6,,,3,,1.25,0,600,600,3,1,0,2,2.5,0)": ("R3 F-2.5 F3 F-5 F3 F-6 F3 R10", []),
    "CYCLE840(10,0,3,-6,,0.5,0,3,0,,1.25)": ("R3 F-6 F3 R10", [0.5]),
    "CYCLE85(10,0,3,-6,,0.5,100,200)": ("R3 F-6 F3 R10", [0.5]),
    "CYCLE86(10,0,3,-6,,0.5,3,1,0,0.5,90)": ("R3 F-6 R-5.5 R3 R10", [0.5]),
    "CYCLE87(10,0,3,-6,,3)": ("R3 F-6 R10", []),
    "CYCLE88(10,0,3,-6,,0.5,3)": ("R3 F-6 R10", [0.5]),
    "CYCLE89(10,0,3,-6,,0.5)": ("R3 F-6 F3 R10", [0.5]),
}


@pytest.mark.parametrize("call", CALLS)
def test_each_cycle_makes_the_motions_of_the_manual(call: str, run: Runner) -> None:
    """Worked out by hand from the cycles manual: RTP 10, RFP 0, SDIS 3, so it feeds from Z3 and is drawn back to Z10.

    81, 82, 87 and 88 leave at rapid (87 and 88 once the operator goes on), 85 and 89 at feed up to Z3, and so do taps;
    86 lifts off aside first. 83 breaks chips by VRT (VARI 0), or goes out to Z3 and back to DIS1 above the last depth.
    """
    got = run(HEAD + call)
    motions, dwells = CALLS[call]
    told = [
        f"{'R' if kind == Kind.RAPID else 'F'}{height:g}"
        for kind, height in zip(got.kind[1:], heights(got)[1:], strict=True)
    ]
    assert " ".join(told) == motions
    assert [event.value for event in got.events if event.kind == "dwell" and event.value] == dwells


#: The long form of an 840D sl -> the same in the classic form, or the code of what is refused.
LONG = {
    "CYCLE81(10,0,3,-6,,,0,1,2)": "CYCLE81(10,0,3,-6)",
    "CYCLE81(10,0,3,,6,,0,0,11)": "CYCLE81(10,0,3,-6)",
    "CYCLE82(10,0,3,-6,,0.5,0,1,12)": "CYCLE82(10,0,3,-6,,0.5)",
    "CYCLE82(10,0,3,-6,6,0.5,0,1,12)": "CYCLE82(10,0,3,-6,,0.5)",
    "CYCLE82(10,0,3,-6,,5,0,1,22)": "CYCLE82(10,0,3,-6,,-5)",
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,0.5,2,,0,1,111112)": "CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,0.5,2)",
    "CYCLE83(10,0,3,-15,,-5,,0,0,0,1,0,3,0,0.5,2,,0,1,1021112)": "CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,0.5,2)",
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,1,3,0,0,2,1,0,1,1011112)": "CYCLE83(10,0,3,-15,,,5,0,0,0,1,1,3,0,0,2,1)",
    'CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600,3,1,0,0,,,"","","",0,1,1001002)': (
        "CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600)"
    ),
    'CYCLE84(10,0,3,-6,,0.5,4,,-1.25,0,600,600,3,1,0,0,,,"ISO_METRIC","M8","",0,1,2002)': (
        "CYCLE84(10,0,3,-6,,0.5,4,,-1.25,0,600,600)"
    ),
    'CYCLE840(10,0,3,-6,,0.5,0,3,0,,1.25,3,1,0,"","","",0,1,2)': "CYCLE840(10,0,3,-6,,0.5,0,3,0,,1.25)",
    "CYCLE85(10,0,3,-6,,0.5,100,200,0,1,12)": "CYCLE85(10,0,3,-6,,0.5,100,200)",
    "CYCLE86(10,0,3,-6,,0.5,3,1,0,0.5,90,0,1,12)": "CYCLE86(10,0,3,-6,,0.5,3,1,0,0.5,90)",
    "CYCLE88(10,0,3,-6,,0.5,3,0,1,0)": "CYCLE88(10,0,3,-6,,0.5,3)",
    "CYCLE81(10,0,3,-6,,,1,1,2)": "NC220",
    "CYCLE81(10,0,3,-6,,,0,2,2)": "NC380",
    "CYCLE81(10,0,3,-6,,,0,1,1)": "NC380",
    "CYCLE81(10,0,3,,6,,0,1,2)": "NC380",
    "CYCLE81(10,0,3,-6,7,,0,1,2)": "NC380",
    "CYCLE81(10,0,3,-6,,,0,1,3)": "NC220",
    "CYCLE81(10,0,3,-6,,,0,1,112)": "NC220",
    "CYCLE81(10,0,3,-6,,,0,1,-2)": "NC220",
    "CYCLE81(10,0,3,-6,,,0,1,2.5)": "NC220",
    "CYCLE81(10,0,3,-6,,,0,1,1000000002)": "NC220",
    "CYCLE82(10,0,3,-6,,-5,0,1,12)": "NC380",
    "CYCLE83(10,0,3,-15,,,5,90,0,0,1,0,3,0,0.5,2,,0,1,211112)": "NC220",
    "CYCLE83(10,0,3,-15,,,5,-0.9,0,0,1,0,3,0,0.5,2,,0,1,111112)": "NC380",
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,1,3,0,0,2,0,0,1,1011112)": "NC220",
    "CYCLE83(10,0,3,-15,,,5,0,0,0,90,0,3,0,0.5,2,,0,1,11111112)": "NC220",
    "CYCLE83(10,0,3,-15,,,5,0,0,0,1,0,3,0,0.5,2,,0,1,121112)": "NC380",
    'CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600,3,1,0,0,,,"","","",0,1,2002)': "NC380",
    'CYCLE84(10,0,3,-6,,0.5,3,,,0,600,600,3,1,0,0,,,"ISO_METRIC","M8","",0,1,2)': "NC380",
    'CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600,3,1,0,0,,,"","","",0,100,2)': "NC380",
    "CYCLE88(10,0,3,-6,,0.5,3,0,1,2)": "NC220",
    "CYCLE84(10,0,3,-6,,0.5,3,,1.25,0,600,600,3,1,0,0,,,5,,,0,1,2)": "NC380",
    "CYCLE840(10,0,3,-6,,0.5,0,3,0,5,1.25,3,1,0,,,,0,1,2)": "NC380",
    "CYCLE840(10,0,3,-6,,0.5,0,3,0)": "NC380",
    "CYCLE840(10,0,3,-6,,0.5,0,3,20)": "NC380",
    "CYCLE840(10,0,3,-6,,0.5,0,3,0,,1.25,3,1,0,,5,,0,1,2)": "NC380",
}


@pytest.mark.parametrize("call", LONG)
def test_the_long_form_is_read_digit_by_digit(call: str, run: Runner) -> None:
    got, wanted = run(HEAD + call), LONG[call]
    if wanted.startswith("NC"):
        assert [finding.code for finding in got.errors] == [wanted]
        assert len(got) == 1
        return
    classic = run(HEAD + wanted)
    assert [finding.code for finding in got.errors] == [finding.code for finding in classic.errors] == []
    np.testing.assert_allclose(heights(got), heights(classic), rtol=0, atol=1e-12)
    assert (got.kind == classic.kind).all()
    assert [event.value for event in got.events] == [event.value for event in classic.events]
