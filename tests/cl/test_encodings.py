"""Names come out as people wrote them, whatever the file is written in."""

import pytest

from tests.support.cl_reading import Read
from trunnion.model.toolpath import Message


@pytest.mark.parametrize(
    ("name", "encoding"),
    [
        ("pièce", "utf-8"),
        ("轮廓粗加工", "utf-8"),
        ("контур", "utf-8"),
        ("Ø10", "utf-8"),
        ("pièce", "utf-8-sig"),
        ("轮廓粗加工", "gb18030"),
        ("SEMI-凸", "gb18030"),
        ("SEMI-凹", "gb18030"),
        ("D10铣刀_精", "gb18030"),
        ("CAVITY（粗）", "gb18030"),
        ("pièce", "latin-1"),
        ("Fräser", "latin-1"),
        ("GRÖßE", "latin-1"),
        ("Größe Ø10", "latin-1"),
        ("Überlänge à façon", "latin-1"),
        ("FRÄSEN_SCHRÄG", "latin-1"),
        ("45° geneigt", "latin-1"),
    ],
)
def test_a_name_is_read_in_its_encoding(read: Read, name: str, encoding: str) -> None:
    text = f"TOOL PATH/{name},TOOL,{name}\nPPRINT/{name}\nGOTO/1,2,3\nEND-OF-PATH\n"
    (operation,) = read(text.encode(encoding)).operations
    assert operation.events == (Message(0, 2, name),)
    assert (operation.name, operation.tool.name) == (name, name)


def test_a_byte_order_mark_does_not_shift_lines(read: Read) -> None:
    (operation,) = read("TOOL PATH/A,TOOL,T\nGOTO/1,2,3\nEND-OF-PATH\n".encode("utf-8-sig")).operations
    assert (operation.line, operation.moves.line.tolist()) == (1, [2])
