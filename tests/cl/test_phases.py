"""What the colours say of the part that each row plays."""

import numpy as np
import pytest

from tests.support.cl_reading import Body, Read
from trunnion.cl.phases import fill_phases
from trunnion.model.toolpath import Phase

Q, R, A, E, C, S, X, D, T = (
    Phase.INITIAL,
    Phase.RAPID,
    Phase.APPROACH,
    Phase.ENGAGE,
    Phase.CUT,
    Phase.STEPOVER,
    Phase.RETRACT,
    Phase.DEPARTURE,
    Phase.TRAVERSE,
)


def phases(colours: list[int], rapids: tuple[int, ...] = ()) -> list[int]:
    """Phases of a path with one row a colour; 0 is a row without one."""
    phase = np.empty(len(colours), np.uint8)
    fill_phases(phase, np.array(rapids, np.int64), [(row, colour) for row, colour in enumerate(colours) if colour])
    return list(phase.tolist())


@pytest.mark.parametrize(
    ("colours", "expected"),
    [
        ([186, 42, 31, 36, 31, 37, 186], [Q, E, C, S, C, X, R]),
        ([186, 0, 211, 42, 31, 37, 211], [Q, Q, A, E, C, X, D]),
        ([186, 211, 42, 31, 37, 211, 211, 42], [Q, A, E, C, X, D, A, E]),
        ([186, 42, 31, 211, 211, 211, 211, 31], [Q, E, C, D, T, T, A, C]),
        ([186, 211, 211, 211, 42], [Q, T, T, A, E]),
        ([186, 31, 186, 211, 42], [Q, C, R, A, E]),
        ([0, 0, 31], [Q, Q, C]),
        ([211, 211, 42], [T, A, E]),
        ([31, 31], [C, C]),
        ([186, 31, 99, 42], [Q, C, C, E]),
    ],
)
def test_colours_give_phases(colours: list[int], expected: list[int]) -> None:
    assert phases(colours) == expected


def test_without_colours_rapids_are_rapid_and_the_rest_is_cutting() -> None:
    assert phases([0, 0, 0], (0, 2)) == [R, C, R]
    assert phases([0, 99, 0], (0, 2)) == [R, C, R]


def test_a_colour_without_rows_counts_for_nothing() -> None:
    phase = np.empty(2, np.uint8)
    fill_phases(phase, np.zeros(0, np.int64), [(0, 186), (1, 31), (1, 211), (1, 31), (2, 186)])
    assert phase.tolist() == [Q, C]


def test_a_colour_without_a_meaning_is_remarked_once(read: Read) -> None:
    toolpath = read("TOOL PATH/A,TOOL,T\nPAINT/COLOR,7\nGOTO/0,0,0\nPAINT/COLOR,7\nGOTO/1,0,0\nEND-OF-PATH\n")
    assert len(toolpath.remarks) == 1
    assert "colour 7" in toolpath.remarks[0].what


def test_the_path_of_a_roughing_pass_reads_as_the_machine_names_it(body: Body) -> None:
    moves = body(
        *("PAINT/COLOR,186", "RAPID", "GOTO/0,0,50", "PAINT/COLOR,211", "RAPID", "GOTO/0,0,2"),
        *("PAINT/COLOR,42", "GOTO/0,0,0", "PAINT/COLOR,31", "GOTO/9,0,0", "PAINT/COLOR,37", "GOTO/9,0,2"),
        *("PAINT/COLOR,211", "RAPID", "GOTO/9,0,50", "RAPID", "GOTO/0,9,50"),
        *("PAINT/COLOR,211", "RAPID", "GOTO/0,9,2", "PAINT/COLOR,42", "GOTO/0,9,0"),
    ).moves
    assert moves.phase.tolist() == [Q, A, E, C, X, D, D, A, E]
