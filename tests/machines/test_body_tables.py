"""Bodies of a machine definition, and every mistake in them with its line."""

import re
from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.machines import BodyBox, BodyCylinder, BodyFile, Machine, MachineBody, load_machine

HEAD = 'extends = "linuxcnc_5axis"\nname = "Ours"\n[[body]]\n'
BOX = 'name = "block"\nlink = "bed"\nshape = "box"\nsize_mm = [10, 20, 30]\ncentre_mm = [0, 0, -900]\n'


def loaded(folder: Path, text: str, name: str = "ours.toml") -> Machine:
    (folder / name).write_text(text, encoding="utf-8")
    return load_machine(folder / name)


def own(machine: Machine) -> dict[str, MachineBody]:
    return {body.name: body for body in machine.bodies}


def test_each_shape_is_read_with_its_place(tmp_path: Path) -> None:
    bodies = own(
        loaded(
            tmp_path,
            f'{HEAD}{BOX}turn_deg = [0, 0, 45]\ncolour = "#A0b1c2"\n'
            '[[body]]\nname = "quill"\nlink = "Z"\nshape = "cylinder"\ndiameter_mm = 200\nlength_mm = 600\n'
            "centre_mm = [0, 0, 900]\ndirection = [0, 0, -2]\n"
            '[[body]]\nname = "guard"\nlink = "workpiece"\nshape = "file"\nfile = "meshes/guard.stl"\nunit = "inch"\n'
            "origin_mm = [1, 2, 3]\n",
        )
    )
    assert bodies["block"].shape == BodyBox((10.0, 20.0, 30.0), (0.0, 0.0, -900.0), (0.0, 0.0, 45.0))
    assert (bodies["block"].link, bodies["block"].colour, bodies["block"].place[1]) == ("bed", "#A0b1c2", 4)
    assert bodies["quill"].shape == BodyCylinder(200.0, 600.0, (0.0, 0.0, 900.0), (0.0, 0.0, -1.0))
    of = str(tmp_path / "ours.toml")
    assert bodies["guard"].shape == BodyFile("meshes/guard.stl", of, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), "inch")


def test_a_definition_that_extends_changes_adds_and_removes_bodies(tmp_path: Path) -> None:
    loaded(tmp_path, f'{HEAD}{BOX}[[body]]\nname = "guard"\nlink = "Z"\nshape = "file"\nfile = "guard.stl"\n')
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "part.stl").write_bytes(b"")
    machine = loaded(
        tmp_path,
        'extends = "./ours.toml"\nname = "Theirs"\n[[body]]\nname = "block"\nsize_mm = [1, 2, 3]\n'
        '[[body]]\nname = "guard"\nremove = true\n',
        "theirs.toml",
    )
    bodies = own(machine)
    assert bodies["block"].shape == BodyBox((1.0, 2.0, 3.0), (0.0, 0.0, -900.0))
    assert "guard" not in bodies


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (BOX.replace('"bed"', '"Q"'), 5, 'body[#].link is "Q"'),
        (BOX.replace('"box"', '"sphere"'), 6, 'body[#].shape is "sphere"'),
        (BOX.replace("size_mm = [10, 20, 30]\n", ""), 3, "body[#].size_mm is missing"),
        (BOX.replace("[10, 20, 30]", "[10, 0, 30]"), 7, "has a side that is not above 0"),
        (BOX.replace("[10, 20, 30]", "[10, 20]"), 7, "body[#].size_mm is [10, 20]"),
        (BOX + "diameter_mm = 5\n", 9, 'diameter_mm is given for shape = "box"'),
        (BOX + 'colour = "red"\n', 9, 'colour is "red"; write "#rrggbb"'),
        (BOX + "sise_mm = 5\n", 9, 'did you mean "size_mm"?'),
        (BOX.replace("block", " block"), 4, "begins or ends with blanks"),
        ('name = "m"\nlink = "Z"\nshape = "file"\n', 3, "body[#].file is missing; write the name of a mesh file"),
        ('name = "m"\nlink = "Z"\nshape = "file"\nfile = "../a.stl"\n', 7, "leads out of the folder"),
        ('name = "m"\nlink = "Z"\nshape = "file"\nfile = "/a.stl"\n', 7, "leads out of the folder"),
        ('name = "m"\nlink = "Z"\nshape = "file"\nfile = "a.step"\n', 7, 'file is "a.step"'),
        ('name = "m"\nlink = "Z"\nshape = "file"\nfile = "a.stl"\nunit = "cm"\n', 8, 'unit is "cm"'),
        ('name = "m"\nlink = "Z"\nshape = "cylinder"\nlength_mm = 5\ncentre_mm = [0, 0, 0]\n', 3, "diameter"),
        (
            'name = "m"\nlink = "Z"\nshape = "cylinder"\ndiameter_mm = -5\nlength_mm = 5\ncentre_mm = [0, 0, 0]\n',
            7,
            "diameter_mm is -5",
        ),
        (f'{BOX}[[body]]\n{BOX.replace("block", "Block")}', 10, "the name of another body too"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_body_is_told_with_its_line(text: str, line: int, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        loaded(tmp_path, HEAD + text)
    (problem,) = caught.value.problems
    assert problem.line == line, problem
    assert words in re.sub(r"(?<=error: )body \w+ |body\[\d+\]\.", "body[#].", str(problem))
