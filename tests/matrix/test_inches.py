"""CL files in mm and inches become programs in mm and inches, on every control; all are proven, and all move alike."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.matrix.covering import case
from tests.support.matrix.expected import FAMILIES, REFUSED
from tests.support.matrix.pairs import CONTROLS, FEW, check_refused, pair_of
from tests.support.matrix.pairs import posted as posted_by_command
from trunnion.controls.vocabulary import INCH, MM

MACHINE = "generic_head_table_bc"

#: Controls of which it is not known how they count inches.
WITHOUT_INCHES = ("fidia_nc15",)

IN_INCHES = [control for control in CONTROLS if control not in WITHOUT_INCHES]

#: Unit of a CL file -> mm, its name, and the words of its feeds.
CL_UNITS = {MM: (1.0, "MM", "MMPM", "MMPR"), INCH: (25.4, "INCHES", "IPM", "IPR")}

lengths = st.integers(-900, 900).map(lambda tenths: 0.1 * tenths)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("inches")


def cl_text(unit: str, x: float, y: float, radius: float, feed: float) -> str:
    """A contour with an arc, and holes of three cycles, in a unit: the same lengths in mm in both."""
    mm, name, per_minute, per_turn = CL_UNITS[unit]

    def of(*values: float) -> str:
        return ",".join(f"{value / mm:.9f}" for value in values)

    return f"""UNITS/{name}
TOOL PATH/CONTOUR,TOOL,EM10
TLDATA/MILL,{of(10, 0, 75)},0.0000,0.0000
INTOL/{of(0.005)}
OUTTOL/{of(0.005)}
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/{of(x, y, 50)},0.0,0.0,1.0
FEDRAT/{per_minute},{of(feed)}
GOTO/{of(x, y, -1)}
CIRCLE/{of(x, y + radius, -1)},0.0,0.0,1.0,{of(radius)},0.06,0.5,{of(10)},0.0
GOTO/{of(x + radius, y + radius, -1)}
RAPID
GOTO/{of(x + radius, y + radius, 50)}
END-OF-PATH
TOOL PATH/HOLES,TOOL,DR6
TLDATA/DRILL,{of(6, 0, 75)},118.0,50.0
INTOL/{of(0.005)}
OUTTOL/{of(0.005)}
LOAD/TOOL,2
SPINDL/RPM,800,CLW
RAPID
GOTO/{of(0, 0, 50)},0.0,0.0,1.0
CYCLE/DRILL,FEDTO,{of(-12)},RAPTO,{of(3)},RTRCTO,{of(20)},DWELL,0.5,{per_minute},{of(feed)}
GOTO/{of(x, y, 0)}
GOTO/{of(-x, y, 2)}
CYCLE/DRILL,DEEP,STEP,{of(4)},FEDTO,{of(-12)},RAPTO,{of(3)},RTRCTO,{of(20)},{per_minute},{of(feed)}
GOTO/{of(x, -y, 0)}
CYCLE/TAP,FEDTO,{of(-10)},RAPTO,{of(5)},RTRCTO,{of(20)},{per_turn},{of(1.27)}
GOTO/{of(-x, -y, 0)}
CYCLE/OFF
RAPID
GOTO/{of(0, 0, 50)}
END-OF-PATH
"""


def posted(control: str, folder: Path, text: str, units: str) -> tuple[Path, trunnion.PostResult]:
    pair, cl, program = pair_of(control, MACHINE, folder), folder / "part.cls", folder / f"{units}.nc"
    cl.write_text(text, encoding="utf-8")
    words = dict(setting.split("=") for setting in pair.settings)
    return program, trunnion.post(cl, machine=pair.file, output=program, settings={**words, "units": units})


@pytest.mark.third
@pytest.mark.parametrize("control", IN_INCHES)
def test_all_units_of_path_and_program_are_proven_and_move_alike(control: str, folder: Path) -> None:
    @settings(parent=FEW, deadline=None)
    @given(x=lengths, y=lengths, radius=st.integers(2, 50).map(float), feed=st.integers(100, 2000).map(float))
    def every(x: float, y: float, radius: float, feed: float) -> None:
        of_mm = {
            (cl, nc): posted(control, folder, cl_text(cl, x, y, radius, feed), nc)[1]
            for cl in CL_UNITS
            for nc in (MM, INCH)
        }
        first = of_mm[MM, MM].run
        for (_, nc), result in of_mm.items():
            assert result.passed
            assert result.run is not None
            assert first is not None
            assert bool(result.run.inches[-1]) is (nc == INCH)
            assert len(result.run) == len(first)
            np.testing.assert_allclose(result.run.tip, first.tip, rtol=0.0, atol=0.006)
            np.testing.assert_allclose(result.run.feed, first.feed, rtol=2e-3, equal_nan=True)

    every()


#: Reasons for which inches are refused, by the family of controls.
ONLY_MM = {"heidenhain_itnc530": {"simultaneous milling without TCP": "how F counts degrees beside inches"}}


@pytest.mark.parametrize(
    ("machine", "control", "path"), [case(MACHINE, control, path) for path in FAMILIES for control in IN_INCHES]
)
def test_every_family_of_paths_is_proven_in_inches(machine: str, control: str, path: str, folder: Path) -> None:
    pair, (family, asked) = pair_of(control, machine, folder), FAMILIES[path]
    refused = REFUSED.get(pair.family, {}).get(path) or ONLY_MM.get(pair.family, {}).get(path)

    @settings(parent=FEW, deadline=None, max_examples=2)
    @given(st.composite(family)(pair.machine))
    def every(text: str) -> None:
        done = posted_by_command(text, pair, folder, (*asked, "units=inch"))
        if refused and done.code:
            check_refused(done, refused)
        else:
            assert (done.code, done.failed) == (0, []), done.err

    every()


@pytest.mark.third
@pytest.mark.parametrize("control", IN_INCHES)
@pytest.mark.parametrize("units", [MM, INCH])
def test_verify_notices_the_wrong_unit(units: str, control: str, folder: Path) -> None:
    program, _ = posted(control, folder, cl_text(MM, 30.0, 20.0, 10.0, 500.0), units)
    pair, text = pair_of(control, MACHINE, folder), program.read_text(encoding="utf-8")
    words = pair.control.unit_words
    word, other = words[units], words[INCH if units == MM else MM]
    assert trunnion.verify(program, machine=pair.file, cl=folder / "part.cls").passed
    swapped = re.sub(rf"(?<=[ \n]){word}(?=[ \n])", other, text)
    assert swapped != text
    faulty = {swapped}
    if units == INCH and word.startswith("G"):
        faulty |= {re.sub(rf"(?<=[ \n]){word} ", "", text), re.sub(rf"^[^\n]*{word} [^\n]*\n", "", text, flags=re.M)}
    assert text not in faulty
    # The program posted stays as it was written: a file edited by hand is not replaced by the next.
    edited = folder / "edited.nc"
    for wrong in faulty:
        edited.write_text(wrong, encoding="utf-8")
        assert not trunnion.verify(edited, machine=pair.file, cl=folder / "part.cls").passed


@pytest.mark.third
@pytest.mark.parametrize("control", IN_INCHES)
@pytest.mark.parametrize(("source", "target"), [(MM, INCH), (INCH, MM), (INCH, INCH)])
def test_programs_are_converted_from_unit_to_unit(source: str, target: str, control: str, folder: Path) -> None:
    program, _ = posted(control, folder, cl_text(MM, 30.0, 20.0, 10.0, 500.0), source)
    pair, output = pair_of(control, MACHINE, folder), folder / "converted.nc"
    extra = dict(setting.split("=") for setting in pair.settings)
    converted = trunnion.convert(
        program,
        machine=pair.file,
        to_machine=pair.file,
        output=output,
        zero=extra.get("zero"),
        tool_length=extra.get("tool_length"),
        settings={**extra, "units": target},
    )
    assert converted.posted is not None
    assert converted.posted.passed
    assert "tolerance" not in converted.settings or abs(float(converted.settings["tolerance"]) - 0.01) < 2e-4
    assert trunnion.diff(program, output, machine=pair.file, tolerance=0.01).same


@pytest.mark.parametrize("control", WITHOUT_INCHES)
def test_a_control_whose_inches_are_not_known_refuses_them(control: str, folder: Path) -> None:
    with pytest.raises(trunnion.InputError, match="has no words for programs in inches"):
        posted(control, folder, cl_text(MM, 30.0, 20.0, 10.0, 500.0), INCH)
