"""Keys of ``[control.reading]`` that say in what form programs are written, and how their control starts."""

from pathlib import Path

import pytest

import trunnion
from tests.support import forms_page
from trunnion.errors import InputError
from trunnion.model.run import Run
from trunnion.readers.program.forms import form_keys, keys_of

FANUC, LINUXCNC, FIDIA, SINUMERIK, KLARTEXT = "matsuura_mx330", "xyzac_trt", "hs664rt", "yl569", "dmu65"

#: A key, the machines that have it, and a program that reads as the other one only with the key.
SAME_WITH_KEY = [
    (
        'tape_marks = "ignored"',
        LINUXCNC,
        "%\nG21 G90 G94\nG1 X5 F9\n%\nG1 X7\nM2\n",
        "G21 G90 G94\nG1 X5 F9\nG1 X7\nM2\n",
    ),
    ('program_numbers = [":"]', LINUXCNC, ":0012 (PART)\nG21 G1 X5 F9\nM2\n", "G21 G1 X5 F9\nM2\n"),
    ('program_numbers = ["%"]', FANUC, "%\n%1234\nG21 G1 X5. F9.\nM30\n%\n", "%\nO1234\nG21 G1 X5. F9.\nM30\n%\n"),
    ('program_numbers = ["O"]', SINUMERIK, "O1234\nG1 X5 F9\nM30\n", "G1 X5 F9\nM30\n"),
    (
        'numbers_anywhere = "anywhere"',
        FANUC,
        "O1\nG21 G1 N5 X5. F9.\n/X7. N6\nM30\n",
        "O1\nN5 G21 G1 X5. F9.\n/N6 X7.\nM30\n",
    ),
    ('numbers_anywhere = "anywhere"', SINUMERIK, "G1 N5 X5 F9\nM30\n", "N5 G1 X5 F9\nM30\n"),
    ('more_comments = [";"]', FANUC, "O1\nG21 G1 X5. F9. ; FIRST (1)\nM30\n", "O1\nG21 G1 X5. F9.\nM30\n"),
    ('more_comments = ["\'"]', LINUXCNC, "G21 G1 X5 F9 'FIRST\nM2\n", "G21 G1 X5 F9\nM2\n"),
    ('more_comments = ["{", "!"]', FIDIA, "G71 G90\nG1 X5 {FIRST} F9\nX7 ! LAST\nM2\n", "G71 G90\nG1 X5 F9\nX7\nM2\n"),
    ('more_comments = ["{"]', SINUMERIK, 'G1 X5 F9 {FIRST}\nMSG("{A}")\nM30\n', 'G1 X5 F9\nMSG("{A}")\nM30\n'),
    (
        'more_comments = ["!"]',
        KLARTEXT,
        "0 BEGIN PGM A MM\n1 L X+5 R0 F9 ! FIRST\n2 M30\n3 END PGM A MM\n",
        "0 BEGIN PGM A MM\n1 L X+5 R0 F9\n2 M30\n3 END PGM A MM\n",
    ),
    (
        'nested_comments = "counted"',
        FANUC,
        "O1\nG21 G1 X5. F9. (A (B) (C(D)))\n(E (F))\nX7. (G) Y1.\nM30\n",
        "O1\nG21 G1 X5. F9. (A)\n(E)\nX7. (G) Y1.\nM30\n",
    ),
    ('nested_comments = "counted"', LINUXCNC, "G21 G1 X5 F9 (A (B))\nM2\n", "G21 G1 X5 F9 (A)\nM2\n"),
    ('nested_comments = "counted"', FIDIA, "G71 G90\nG1 X5 F9 (A (B))\nM2\n", "G71 G90\nG1 X5 F9\nM2\n"),
    ('block_ends = ["*"]', FANUC, "O1*\nG21 G1 X5. F9.*(A)\nM30*\n", "O1\nG21 G1 X5. F9.(A)\nM30\n"),
    ('block_ends = ["LF", "$"]', SINUMERIK, "G1 X5 F9 LF\nX7$\nM30LF\n", "G1 X5 F9\nX7\nM30\n"),
    ('start_distances = "incremental"', FANUC, "O1\nG21 G1 X5. F9.\nX5.\nM30\n", "O1\nG91 G21 G1 X5. F9.\nX5.\nM30\n"),
    ('start_distances = "incremental"', LINUXCNC, "G21 G1 X5 F9\nX5\nM2\n", "G91 G21 G1 X5 F9\nX5\nM2\n"),
    ('start_distances = "incremental"', FIDIA, "G71\nG1 X5 F9\nX5\nM2\n", "G91 G71\nG1 X5 F9\nX5\nM2\n"),
    ('start_distances = "incremental"', SINUMERIK, "G1 X5 F9\nX5\nM30\n", "G91 G1 X5 F9\nX5\nM30\n"),
    (
        'start_plane = "G18"',
        FANUC,
        "O1\nG21 G1 X0. Y0. Z0. F9.\nG2 X5. Z5. R5. F9.\nM30\n",
        "O1\nG18 G21 G1 X0. Y0. Z0. F9.\nG2 X5. Z5. R5. F9.\nM30\n",
    ),
    ('start_plane = "G19"', SINUMERIK, "G2 Y5 Z5 CR=5 F9\nM30\n", "G19 G2 Y5 Z5 CR=5 F9\nM30\n"),
    (
        'arc_centres = "absolute"',
        LINUXCNC,
        "G21 G1 X5 F9\nG2 X7 Y2 I7 J0\nM2\n",
        "G90.1 G21 G1 X5 F9\nG2 X7 Y2 I7 J0\nM2\n",
    ),
    (
        'arc_centres = "absolute"',
        FANUC,
        "O1\nG21 G1 X5. Y0. F9.\nG2 X7. Y2. I7. J0.\nM30\n",
        "O1\nG21 G1 X5. Y0. F9.\nG2 X7. Y2. I2. J0.\nM30\n",
    ),
    (
        'arc_centres = "incremental"',
        FIDIA,
        "G71 G90\nG1 X5 F9\nG2 X7 Y2 I2 J0\nM2\n",
        "G71 G90\nG1 X5 F9\nG2 X7 Y2 I7 J0\nM2\n",
    ),
    (
        'arc_vectors = "from_centre"',
        FANUC,
        "O1\nG21 G1 X5. Y0. F9.\nG3 X0. Y5. I5. J0.\nM30\n",
        "O1\nG21 G1 X5. Y0. F9.\nG3 X0. Y5. I-5. J0.\nM30\n",
    ),
    (
        'arc_vectors = "unsigned"',
        FANUC,
        "O1\nG21 G1 X3. Y4. F9.\nG3 X0. Y5. I3. J4.\nG2 X4. Y3. I0. J5.\nG3 X1. Y0. I0. J3.\nM30\n",
        "O1\nG21 G1 X3. Y4. F9.\nG3 X0. Y5. I-3. J-4.\nG2 X4. Y3. I0. J-5.\nG3 X1. Y0. I0. J-3.\nM30\n",
    ),
    (
        'arc_vectors = "from_centre"',
        LINUXCNC,
        "G21 G1 X5 Y0 F9\nG3 X0 Y5 I5 J0\nM2\n",
        "G21 G1 X5 Y0 F9\nG3 X0 Y5 I-5 J0\nM2\n",
    ),
    (
        'arc_vectors = "from_centre"\narc_centres = "incremental"',
        FIDIA,
        "G71 G90\nG1 X5 Y0 F9\nG3 X0 Y5 I5 J0\nM2\n",
        "G71 G90\nG1 X5 Y0 F9\nG3 X0 Y5 I0 J0\nM2\n",
    ),
    (
        'behind_circles = "line"',
        FANUC,
        "O1\nG21 G1 X0. Y0. F9.\nG2 X2. Y2. R2. F9.\nX9.\nM30\n",
        "O1\nG21 G1 X0. Y0. F9.\nG2 X2. Y2. R2. F9.\nG1 X9.\nM30\n",
    ),
    (
        'behind_circles = "line"',
        LINUXCNC,
        "G21 G90 G94\nG1 X0 Y0 F9\nG2 X10 Y0 I5 J0\nX20\nX30 F8\nM2\n",
        "G21 G90 G94\nG1 X0 Y0 F9\nG2 X10 Y0 I5 J0\nG1 X20\nX30 F8\nM2\n",
    ),
    (
        'behind_circles = "line"',
        FIDIA,
        "G71 G90\nG1 X5 F9\nG2 X7 Y2 I7 J0\nX9\nM2\n",
        "G71 G90\nG1 X5 F9\nG2 X7 Y2 I7 J0\nG1 X9\nM2\n",
    ),
    ('start_plane = "G18"', LINUXCNC, "G21 G1 X0 F9\nG2 X5 Z5 R5\nM2\n", "G18 G21 G1 X0 F9\nG2 X5 Z5 R5\nM2\n"),
    (
        'start_plane = "G18"',
        FIDIA,
        "G71 G1 X5 Z0 F9\nG2 X7 Z2 I7 K0\nM2\n",
        "G18 G71 G1 X5 Z0 F9\nG2 X7 Z2 I7 K0\nM2\n",
    ),
    ('numbers_anywhere = "anywhere"', LINUXCNC, "G21 G1 N5 X5 F9\nM2\n", "N5 G21 G1 X5 F9\nM2\n"),
    ('numbers_anywhere = "anywhere"', FIDIA, "G71 G1 N5 X5 F9\nM2\n", "N5 G71 G1 X5 F9\nM2\n"),
    ('tape_marks = "ignored"', FANUC, "O1\nG21 G1 X5. F9.\n%\nX7.\nM30\n", "O1\nG21 G1 X5. F9.\nX7.\nM30\n"),
    ('tape_marks = "ignored"', FIDIA, "%\nG71 G1 X5 F9\n%\nX7\nM2\n", "G71 G1 X5 F9\nX7\nM2\n"),
    ('program_numbers = ["O"]', FIDIA, "O1234\nG71 G1 X5 F9\nM2\n", "G71 G1 X5 F9\nM2\n"),
    ('block_ends = ["*"]', LINUXCNC, "G21 G1 X5 F9*\nM2*\n", "G21 G1 X5 F9\nM2\n"),
    ('block_ends = ["*"]', FIDIA, "G71 G1 X5 F9*\nM2*\n", "G71 G1 X5 F9\nM2\n"),
    (
        'block_ends = ["*"]',
        KLARTEXT,
        "0 BEGIN PGM A MM*\n1 L X+5 R0 F9*\n2 M30*\n3 END PGM A MM\n",
        "0 BEGIN PGM A MM\n1 L X+5 R0 F9\n2 M30\n3 END PGM A MM\n",
    ),
    (
        'end_in_subprogram = "returns"',
        LINUXCNC,
        "o100 sub\nG1 X7 F9\nM2\no100 endsub\nG21 G1 X5 F9\no100 call\nX9\nM2\n",
        "o100 sub\nG1 X7 F9\no100 return\no100 endsub\nG21 G1 X5 F9\no100 call\nX9\nM2\n",
    ),
    (
        'end_in_subprogram = "returns"',
        FANUC,
        "O1\nG21 G1 X5. F9.\nM98 P2\nX9.\nM30\nO2\nX7.\nM30\n",
        "O1\nG21 G1 X5. F9.\nM98 P2\nX9.\nM30\nO2\nX7.\nM99\n",
    ),
]


def read(folder: Path, machine: str, text: str, keys: str = "") -> Run:
    """Run a text on a machine with keys of its own."""
    program, toml = folder / "a.nc", folder / "ours.toml"
    toml.write_text(f'extends = "{machine}"\n[control.reading]\n{keys}\n')
    program.write_text(text)
    return trunnion.read_program(program, machine=str(toml))


def moved(run: Run) -> tuple[list[list[float]], list[int], list[list[float]]]:
    return run.tip.round(9).tolist(), [int(kind) for kind in run.kind], run.arcs.normal.tolist()


@pytest.mark.parametrize(("key", "machine", "text", "other"), SAME_WITH_KEY)
def test_a_program_reads_with_the_key_as_in_the_form_of_the_family(
    key: str, machine: str, text: str, other: str, tmp_path: Path
) -> None:
    plain, with_key = read(tmp_path, machine, other), read(tmp_path, machine, text, key)
    assert plain.errors == with_key.errors == ()
    assert moved(with_key) == moved(plain)
    without = read(tmp_path, machine, text)
    assert without.errors or moved(without) != moved(plain)


@pytest.mark.parametrize(
    "block",
    ["G3 X-3. Y4. I0. J5.", "G2 X-5. Y0. I0. J5.", "G3 X5. Y0. I0. J5.", "G3 X-4. Y3. I0. J-5.", "G3 X0. Y5. I0. J5."],
)
def test_without_signs_no_circle_leaves_its_quadrant(block: str, tmp_path: Path) -> None:
    run = read(tmp_path, FANUC, f"O1\nG21 G1 X0. Y5. F9.\n{block}\nM30\n", 'arc_vectors = "unsigned"')
    signed = f"O1\nG21 G1 X0. Y5. F9.\n{block.replace('J', 'J-').replace('--', '-')}\nM30\n"
    is_quadrant = block == "G3 X-3. Y4. I0. J5."
    assert [each.code for each in run.errors] == ([] if is_quadrant else ["NC320"])
    assert (moved(run) == moved(read(tmp_path, FANUC, signed))) == is_quadrant


def test_what_the_definition_states_is_not_assumed(tmp_path: Path) -> None:
    text = "O1\nG21 G94 G1 X5. F9.\nM30\n"
    assert {"G90", "G17"} <= set(read(tmp_path, FANUC, text).assumed_modes)
    stated = read(tmp_path, FANUC, text, 'start_distances = "absolute"\nstart_plane = "G17"')
    assert not {"G90", "G17", "G91"} & set(stated.assumed_modes)


def test_a_program_that_ends_with_the_other_distances_is_warned_of(tmp_path: Path) -> None:
    text = "G21 G91 G94 G1 X5 F9\nX5\nG90\nM2\n"
    run = read(tmp_path, FIDIA, text.replace("G21", "G71"), 'start_distances = "incremental"')
    noted = [each.text for each in run.diagnostics]
    assert any("G90" in each for each in noted)


def test_plain_blocks_of_the_kernel_keep_the_form(tmp_path: Path) -> None:
    lines = "".join(f"X{k}.{'*' if k % 40 == 0 else ''}\n" for k in range(1, 400))
    run = read(tmp_path, FANUC, f"O1\nG21 G90 G94 G80 G1 F9.\n{lines}M30\n", 'block_ends = ["*"]')
    assert run.errors == ()
    assert len(run) == 399


def test_comments_are_kept_as_such(tmp_path: Path) -> None:
    keys = 'more_comments = [";"]\nblock_ends = ["*"]'
    run = read(tmp_path, FANUC, "O1 (A)\nG21 G1 X5. F9. (B; C)* ; D (E)\nM30\n", keys)
    assert run.errors == ()
    assert [each.text.strip() for each in run.comments] == ["A", "B; C", "D  E"]


@pytest.mark.parametrize("machine", [FANUC, LINUXCNC, FIDIA, SINUMERIK, KLARTEXT])
def test_words_that_no_key_has_are_mistakes(machine: str, tmp_path: Path) -> None:
    for keys in ('more_comments = ["#"]', 'block_ends = "*"', 'start_plane = "G20"', 'behind_circles = "arc"'):
        with pytest.raises(InputError):
            read(tmp_path, machine, "M30\n", keys)


@pytest.mark.parametrize("machine", [FANUC, LINUXCNC, FIDIA, SINUMERIK, KLARTEXT])
def test_a_list_of_other_things_is_told_what_it_may_have(machine: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as found:
        read(tmp_path, machine, "M30\n", "block_ends = [1]")
    assert 'block_ends is [1]; write a list of some of "*", ";", "$", "LF", "EOB"' in str(found.value)


@pytest.mark.parametrize("machine", [FANUC, LINUXCNC, FIDIA, SINUMERIK, KLARTEXT])
def test_one_sign_is_no_comment_and_end_of_block_at_once(machine: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match='block_ends has ";", with which more_comments begins comments; leave it in'):
        read(tmp_path, machine, "M30\n", 'more_comments = [";", "!"]\nblock_ends = [";"]')


@pytest.mark.parametrize("sign", ["O", ":", "%"])
def test_a_number_by_another_sign_begins_a_subprogram(sign: str, tmp_path: Path) -> None:
    text = f"%\n{sign}1\nG21 G90 G94 G1 X5. F9.\nM98 P77\nX6.\nM30\n{sign}77 (SUB)\nX9.\nM99\n%\n"
    run = read(tmp_path, FANUC, text, 'program_numbers = ["%"]')
    assert run.errors == ()
    assert (run.xyz[1:, 0] - run.xyz[0, 0]).tolist() == [4.0, 1.0]


def test_each_family_has_its_keys_only(tmp_path: Path) -> None:
    assert {key.name for key in keys_of("heidenhain_tnc640")} == {"more_comments", "block_ends"}
    with pytest.raises(InputError, match="start_plane"):
        read(tmp_path, KLARTEXT, "M30\n", 'start_plane = "G17"')
    assert all(key.meaning and key.families for key in form_keys())


def test_every_key_is_tried_in_every_family_that_has_it() -> None:
    folders = {FANUC: "fanuc", LINUXCNC: "linuxcnc", FIDIA: "fidia", SINUMERIK: "sinumerik", KLARTEXT: "heidenhain"}
    tried = {(key.split(" ")[0], folders[machine]) for key, machine, *_ in SAME_WITH_KEY}
    assert {(key.name, family) for key in form_keys() for family in key.families} == tried


def test_the_page_has_the_keys_as_the_readers_have_them() -> None:
    assert forms_page.FILE.read_text(encoding="utf-8") == forms_page.page(), "python -m tests.support.forms_page"
