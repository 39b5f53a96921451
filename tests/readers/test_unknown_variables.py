"""What a control keeps from one program to the next is not known, until the program or the definition says it."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError
from trunnion.model.run import Run

#: Machines by what a variable of theirs is called.
MACHINES = {
    "#500": "matsuura_mx330",
    "#150": "haas_umc750",
    "#100": "linuxcnc_5axis",
    "#<_edge>": "linuxcnc_5axis",
    "R55": "yl569",
    "Q55": "dmu65",
}

BEGIN = {"dmu65": "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S100\n"}
END = {"dmu65": "9 M30\n10 END PGM A MM\n"}


def read(folder: Path, machine: str, lines: str, definition: str = "") -> Run:
    """Run lines on a machine, or on one with a definition of its own."""
    path, toml = folder / "a.nc", folder / "ours.toml"
    toml.write_text(f'extends = "{machine}"\n{definition}')
    path.write_text(f"{BEGIN.get(machine, '')}{lines}\n{END.get(machine, '')}")
    return trunnion.read_program(path, machine=str(toml))


def block(machine: str, name: str) -> str:
    """Return a block whose end depends on a variable."""
    if machine == "dmu65":
        return f"L X+{name} R0 FMAX"
    head = "O1000\n" if machine == "matsuura_mx330" else "%\nO01000\n" if machine == "haas_umc750" else ""
    return f"G90 G0 X={name}" if machine == "yl569" else f"{head}G90 G0 X[1.+{name}]"


@pytest.mark.parametrize("name", MACHINES)
def test_a_variable_that_nothing_sets_is_not_known(name: str, tmp_path: Path) -> None:
    machine = MACHINES[name]
    run = read(tmp_path, machine, block(machine, name))
    assert [error.code for error in run.errors] == ["NC223"]
    assert f"{name} has no value" in run.errors[0].text


@pytest.mark.parametrize("name", MACHINES)
def test_a_definition_may_declare_it_and_that_is_told_once(name: str, tmp_path: Path) -> None:
    machine = MACHINES[name]
    run = read(tmp_path, machine, block(machine, name), f'[control.reading.variables]\n"{name}" = 2.5\n')
    assert run.errors == ()
    assert [(noted.code, str(noted.severity)) for noted in run.diagnostics if name in noted.text] == [
        ("NC227", "warning")
    ]


@pytest.mark.parametrize(
    ("machine", "lines"),
    [
        ("matsuura_mx330", "O1\nIF [#500 EQ 1] GOTO 5\nG0 X1.\nN5 X2.\nM30"),
        ("matsuura_mx330", "O1\nIF [#500 EQ #0] GOTO 5\nG0 X1.\nN5 X2.\nM30"),
        ("matsuura_mx330", "O1\nWHILE [#500 LT 1] DO1\nG0 X1.\nEND1\nM30"),
        ("matsuura_mx330", "O1\n#1=#101\nM30"),
        ("linuxcnc_5axis", "o1 if [#31 GT 1]\nG0 X1.\no1 endif\nM2"),
        ("linuxcnc_5axis", "o1 repeat [#5]\nG0 X1.\no1 endrepeat\nM2"),
        ("linuxcnc_5axis", "o1 if [EXISTS[#<_edge>]]\nG0 X1.\no1 endif\nM2"),
        ("linuxcnc_5axis", "G0 X[5*EXISTS[#<_edge>]]\nM2"),
        ("linuxcnc_5axis", "#<a>=[EXISTS[#31]]\nM2"),
        ("yl569", "IF R1==1 GOTOF OUT\nG0 X1\nOUT:\nM30"),
        ("yl569", "WHILE R1<2\nG0 X1\nENDWHILE\nM30"),
        ("yl569", "X=$P_TOOLL[1]\nM30"),
        ("yl569", "X=MY_GUD\nM30"),
    ],
)
def test_neither_a_jump_nor_a_loop_may_depend_on_it(machine: str, lines: str, tmp_path: Path) -> None:
    assert read(tmp_path, machine, lines).errors


def test_what_the_program_sets_or_empties_is_known_and_so_are_arguments_left_out(tmp_path: Path) -> None:
    assert read(tmp_path, "matsuura_mx330", "O1\n#500=#0\nIF [#500 EQ #0] THEN #500=1.\nG0 X#500\nM30").errors == ()
    assert read(tmp_path, "linuxcnc_5axis", "o1 sub\nG0 X#2\no1 endsub\no1 call [3]\nM2").errors == ()


@pytest.mark.parametrize(
    ("lines", "definition", "x"),
    [
        ("G0 X[5*EXISTS[#<edge>]]\nM2", "", 0.0),
        ("#<_edge>=7\nG0 X[5*EXISTS[#<_edge>]]\nM2", "", 5.0),
        ("G0 X[5*EXISTS[#<_Edge>]]\nM2", '[control.reading.variables]\n"#<_edge>" = 1\n', 5.0),
        ("G0 X[5*EXISTS[#<_metric>]]\nM2", "", 5.0),
    ],
)
def test_exists_of_what_is_local_set_declared_or_the_controls_own_is_known(
    lines: str, definition: str, x: float, tmp_path: Path
) -> None:
    run = read(tmp_path, "linuxcnc_5axis", f"G21 G90\n{lines}", definition)
    assert run.errors == ()
    assert run.tip[-1, 0] == x


def test_system_variables_may_be_declared_with_their_index(tmp_path: Path) -> None:
    declared = '[control.reading.variables]\n"$TC_DP3[1,1]" = 80\nMY_GUD = 2\n'
    run = read(tmp_path, "yl569", "G0 X=$TC_DP3[1,1]\nY=MY_GUD\nM30", declared)
    assert run.errors == ()
    assert run.tip[-1, :2].tolist() == [80.0, 2.0]


@pytest.mark.parametrize(
    ("machine", "key", "value"),
    [("yl569", "r1", "1"), ("matsuura_mx330", "#5", "1"), ("dmu65", "QL1", "1")],
)
def test_a_declaration_that_fits_no_variable_is_refused(machine: str, key: str, value: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, machine, "G0 X1.", f'[control.reading.variables]\n"{key}" = {value}\n')
    assert [problem.code for problem in refused.value.problems] == ["NC190"]


@pytest.mark.parametrize(
    ("machine", "length", "key", "known"),
    [
        ("matsuura_mx330", "G43 H1 Z50.", 5043, False),
        ("haas_umc750", "G43 H1 Z50.", 5043, False),
        ("haas_umc750", "G43 H1 Z50.", 5041, True),
        ("haas_umc750", "G43 H1 Z50.", 5003, True),
        ("haas_umc750", "G49 Z50.", 5043, True),
    ],
)
def test_a_position_that_counts_the_tool_length_is_known_with_the_length(
    machine: str, length: str, key: int, known: bool, tmp_path: Path
) -> None:
    run = read(tmp_path, machine, f"%\nO00001\nG21 G90 G54\nT1 M6\nG0 X1. Y1.\n{length}\nG0 X#{key}\nM30\n%")
    assert [error.code for error in run.errors] == ([] if known else ["NC222"])
