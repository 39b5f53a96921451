"""What ICAM's table of words (PPTable) makes CATIA write: messages of its post-processor, and TLAXIS as a comment."""

import pytest

from tests.support.cl_reading import Read
from trunnion.errors import TrunnionError
from trunnion.model.toolpath import UnknownStatement

HEAD = ["$$ CATIA APT VERSION 1.0", "UNITS/MM"]
MESSAGES = ["PPFUN/15,1318046,OFF", "PPFUN/15,1319003,OFF"]
SYNONYM = "SYN/'TLAXIS','$$*TLAXIS'"
PART = [
    "TLAXIS/ 0.000000, 0.000000, 1.000000",
    "LOADTL/1",
    "FEDRAT/ 1000.0000,MMPM",
    "SPINDL/ 5000.0000,RPM,CLW",
    "GOTO  /    0.00000,    0.00000,   50.00000, 0.000000, 0.000000, 1.000000",
    "GOTO  /   10.00000,    0.00000,    0.00000, 0.000000, 0.000000, 1.000000",
    "FINI",
]


def written(*lines: str) -> str:
    return "\n".join(lines) + "\n"


def test_messages_and_the_synonym_change_no_point(read: Read) -> None:
    plain = read(written(*HEAD, *PART)).operations[0]
    (operation,) = read(written(*HEAD, *MESSAGES, SYNONYM, *PART)).operations
    assert operation.moves.tip.tolist() == plain.moves.tip.tolist() == [[0, 0, 50], [10, 0, 0]]
    assert operation.moves.axis.tolist() == plain.moves.axis.tolist() == [[0, 0, 1], [0, 0, 1]]
    assert not [event for event in operation.events if isinstance(event, UnknownStatement)]


def test_the_synonym_is_remarked_on(read: Read) -> None:
    (remark,) = read(written(*HEAD, SYNONYM, *PART)).remarks
    assert remark.line == 3
    assert remark.what.startswith("SYN makes TLAXIS a comment for the post-processor of ICAM")


@pytest.mark.parametrize("synonym", ["SYN/'TLAXIS','GOTO'", "SYN/'GOTO','$$*GOTO'", "SYN/CL,CIRCLE", "SYN/"])
def test_another_synonym_is_refused(read: Read, synonym: str) -> None:
    with pytest.raises(TrunnionError, match="SYN gives words other meanings"):
        read(written(*HEAD, synonym, *PART))


@pytest.mark.parametrize("function", ["PPFUN/3,8,'NO_CYCLE'", "PPFUN/15", "PPFUN/15,1,2", "PPFUN/16,1,OFF"])
def test_another_function_of_the_post_processor_is_not_known(read: Read, function: str) -> None:
    (operation,) = read(written(*HEAD, function, *PART)).operations
    (unknown,) = [event for event in operation.events if isinstance(event, UnknownStatement)]
    assert (unknown.line, str(unknown.what), unknown.acts) == (3, "PPFUN is not known", True)


def test_a_tool_axis_that_the_points_contradict_is_refused(read: Read) -> None:
    lines = [*HEAD, SYNONYM, *PART[:-1], "GOTO/1,2,3,1,0,0", "FINI"]
    with pytest.raises(TrunnionError, match="three more numbers behind a point without MULTAX"):
        read(written(*lines))


def test_points_to_which_arcs_could_be_fitted_stay_as_they_are(read: Read) -> None:
    toolpath = read(written(*HEAD, "MODE/CIRCUL,5,2", *PART[:-1], "MODE/LINEAR", "FINI"))
    (operation,) = toolpath.operations
    assert operation.moves.tip.tolist() == [[0, 0, 50], [10, 0, 0]]
    assert [remark.what.split()[0] for remark in toolpath.remarks] == ["MODE/CIRCUL", "MODE/LINEAR"]


def test_other_modes_are_read_as_everywhere(read: Read) -> None:
    with pytest.raises(TrunnionError, match="count from each other"):
        read(written(*HEAD, "MODE/INCR,ON", *PART))
