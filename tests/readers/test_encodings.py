"""Programs with byte order marks and in other encodings, for all families."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program

PROGRAMS = {
    "yl569": "; {0}\nG0 X1 Y2\nX3 ; {0}\nM30\n",
    "dmu65": "0 BEGIN PGM A MM\n1 L X+1 Y+2 FMAX ; {0}\n2 L X+3 FMAX ; {0}\n3 END PGM A MM\n",
    "matsuura_mx330": "%\nO1 ({0})\nG21 G0 X1. Y2.\nX3. ({0})\nM30\n%\n",
    "hs664rt": "( {0} )\nG71 G1 X1. Y2. F3000\nX3. ({0})\nM02\n",
    "xyzac_trt": "%\n({0})\nG21 G0 X1 Y2\nX3 ({0})\nM2\n%\n",
}


def ran(data: bytes, machine: str, folder: Path) -> Run:
    """The run of a program of these bytes."""
    path = folder / ("A.H" if machine == "dmu65" else "A.MPF")
    path.write_bytes(data)
    return run_program(path, load_machine(machine))


@pytest.mark.parametrize("machine", PROGRAMS)
def test_a_byte_order_mark_is_no_word(machine: str, tmp_path: Path) -> None:
    text = PROGRAMS[machine].format("Nut")
    plain, marked = ran(text.encode(), machine, tmp_path), ran(text.encode("utf-8-sig"), machine, tmp_path)
    assert marked.diagnostics == plain.diagnostics == ()
    np.testing.assert_array_equal(marked.joints, plain.joints)
    assert marked.line.tolist() == plain.line.tolist()


@pytest.mark.parametrize("machine", PROGRAMS)
@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_text_of_two_bytes_is_refused(machine: str, encoding: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="UTF-16"):
        ran(PROGRAMS[machine].format("Nut").encode(encoding), machine, tmp_path)


@pytest.mark.parametrize("machine", PROGRAMS)
def test_lines_that_end_in_cr_alone_are_refused(machine: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line ends of CR alone"):
        ran(PROGRAMS[machine].format("Nut").replace("\n", "\r").encode(), machine, tmp_path)


@pytest.mark.parametrize("machine", PROGRAMS)
def test_comments_in_gbk_and_latin_1_are_read(machine: str, tmp_path: Path) -> None:
    for name, encoding in (("轮廓粗加工", "gb18030"), ("Bohrung für Größe", "latin-1"), ("轮廓", "utf-8")):
        run = ran(PROGRAMS[machine].format(name).encode(encoding), machine, tmp_path)
        assert run.diagnostics == ()
        assert {comment.text.strip() for comment in run.comments} == {name}
        assert len(run) == 2


def test_a_byte_order_mark_before_a_jump(tmp_path: Path) -> None:
    text = "MARK: G0 X1\nR1=R1+1\nIF R1<3 GOTOB MARK\nM30\n"
    run = ran(b"\xef\xbb\xbfR1=0\n" + text.encode(), "yl569", tmp_path)
    assert len(run) == 3
    run = ran(b"\xef\xbb\xbf" + ("DEF INT NN=0\n" + text.replace("R1", "NN")).encode(), "yl569", tmp_path)
    assert run.diagnostics == ()


def test_a_character_that_ends_in_a_tilde_continues_no_block(tmp_path: Path) -> None:
    comment = "轮廓粗加工".encode("gb18030") + b"\x81\x7e"
    run = ran(b"0 BEGIN PGM A MM\n1 L X+1 FMAX ;" + comment + b"\n2 L X+2 FMAX\nEND PGM A MM\n", "dmu65", tmp_path)
    assert run.diagnostics == ()
    assert len(run) == 2
