"""A program that selects no work offset: the converted one selects one, which is told once, and hides nothing."""

from pathlib import Path

import pytest

import trunnion

#: A table-table machine under TCP, in the zero that holds when the program starts.
LINES = """T1 M6
M428
G94
S600 M3
G0 X16 Y-25 Z33 A-71 C-35
G1 X6 Y-11 Z27 A-71 C-35 F300
G1 X6 Y-12 Z26 A-70.5 C-32
G1 X5 Y-13 Z26 A-70 C-31
G0 Z60
M429
M2
"""


@pytest.fixture(scope="module")
def converted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, trunnion.ConvertResult]:
    """The program, the one for another machine, and what its conversion said."""
    program = tmp_path_factory.mktemp("no_offset") / "part.ngc"
    program.write_text(LINES, encoding="utf-8")
    target = program.with_name("part.mpf")
    return (
        program,
        target,
        trunnion.convert(program, machine="xyzac_trt", to_machine="yl569", output=target, positions="tip"),
    )


def test_the_conversion_tells_which_work_offset_the_new_program_selects(
    converted: tuple[Path, Path, trunnion.ConvertResult],
) -> None:
    program, _, result = converted
    told = [problem for problem in result.problems if "work offset" in problem.what]
    assert [(problem.file, problem.line, problem.what) for problem in told] == [
        (str(program), 6, "selects no work offset before it cuts; the new program selects work_offset=G54")
    ]


def test_a_work_offset_that_is_given_needs_no_warning(tmp_path: Path) -> None:
    program = tmp_path / "part.ngc"
    for text, settings in ((LINES, {"work_offset": "G55"}), (f"G54\n{LINES}", {})):
        program.write_text(text, encoding="utf-8")
        result = trunnion.convert(program, machine="xyzac_trt", to_machine="yl569", settings=settings, positions="tip")
        assert not [problem for problem in result.problems if "work offset" in problem.what]


def test_the_comparison_tells_it_once_and_compares_the_path(
    converted: tuple[Path, Path, trunnion.ConvertResult],
) -> None:
    program, target, _ = converted
    found = trunnion.diff(program, target, machine="xyzac_trt", to_machine="yl569")
    assert (found.count, found.points) == (1, 5)
    assert found.first is not None
    assert found.first.text.startswith("work offset none against G54, up to 9")
    changed = program.with_name("changed.ngc")
    changed.write_text(LINES.replace("Y-13 ", "Y-13.5 "), encoding="utf-8")
    found = trunnion.diff(changed, target, machine="xyzac_trt", to_machine="yl569")
    assert found.worst is not None
    assert found.worst.text.startswith("tips are 0.500000 mm apart")


@pytest.mark.parametrize("target", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "xyzac_trt"])
def test_two_work_offsets_never_become_one(target: str, tmp_path: Path) -> None:
    """The words of the head are not those of the shipped templates: the run knows the offsets all the same."""
    program, output = tmp_path / "part.nc", tmp_path / "converted.nc"
    cut = "X0. Y0. F3000\nZ5.\nZ-1. F100\nX10. F200\nZ50. F3000\nM242\n"
    head = "N1 G17 Q1\nG90\nG71\nM242\nM306 T.1\n"
    program.write_text(f"{head}G55 O1\nS1000 M3\nG1 {cut}G55 O2\n{cut}M5\nM02\n", encoding="utf-8")
    with pytest.raises(trunnion.TrunnionError, match=r"the work offset is G55 O1,.*G55 O2"):
        trunnion.convert(program, machine="hs664rt", to_machine=target, output=output)
    assert not output.exists()


#: As posts for a Fidia begin: rotary axes turn, at the feed of rapids, before the work offset.
FIDIA_LINES = """G17 Q1
G90
G71
G197
M242
G01 A0. C0. F3000
M306 T.2
G69
G55 O1
G01 C281.034 A-59.186 F3000
G196
S2500 M3
G1 X54.135 Y-0.313 Z-15.036 F3000
X52.294 Y-0.657 Z-16.308 F250
X51.412 Y-0.837 Z-16.996
X54.135 Y-0.313 Z-15.036 F3000
G197
M242
M2
"""


@pytest.mark.parametrize(("removed", "lines"), [("", []), ("M306 T.2\nG69\nG55 O1\n", [11])])
def test_no_turn_of_rotary_axes_before_the_part_is_a_cut(tmp_path: Path, removed: str, lines: list[int]) -> None:
    program = tmp_path / "part.nc"
    program.write_text(FIDIA_LINES.replace(removed, ""), encoding="utf-8")
    result = trunnion.convert(program, machine="hs664rt", to_cl=True)
    assert [problem.line for problem in result.problems if problem.code == "CNV144"] == lines
