"""What a block notes and does that calls a subprogram is told of its own file, not of the one that it calls."""

from pathlib import Path

import pytest

from trunnion.machines import load_machine
from trunnion.readers import RunOptions, run_program


def test_a_note_of_a_calling_block_names_its_own_file(tmp_path: Path) -> None:
    machine = load_machine("yl569", {"control": {"family": "fanuc_30i"}})
    names = [f"O010{k}" for k in range(6)]
    for k, name in enumerate(names):
        call = f"G65 P10{k + 1}\n" if k < 5 else ""
        (tmp_path / f"{name}.nc").write_text(f"{name}\n" + "G4 P1\n" * k + f"{call}M{99 if k else 30}\n")
    files = [tmp_path / f"{name}.nc" for name in names]
    run = run_program(files[0], machine, RunOptions(subprograms=files[1:]))
    (deep,) = (each for each in run.diagnostics if each.wording.code == "NC141")
    assert (Path(deep.file).name, deep.line) == ("O0104.nc", 6)


@pytest.mark.parametrize(
    ("family", "main", "called", "name"),
    [
        ("fanuc_30i", "O1\nM98 P100 M777\nM30\n", "O0100\nG4 P1\nM99\n", "O0100.nc"),
        ("sinumerik_840d", "G71\nSUB M777\nM30\n", "G4 F1\nM17\n", "SUB.SPF"),
        ("heidenhain_tnc640", "BEGIN PGM A MM\nCALL PGM SUB M777\nM30\nEND PGM A MM\n", "L M5\n", "SUB.H"),
    ],
)
def test_an_event_of_a_calling_block_is_one_of_its_own_file(
    family: str, main: str, called: str, name: str, tmp_path: Path
) -> None:
    machine = load_machine("yl569", {"control": {"family": family, "known": {"M777": "stop"}}})
    program, subprogram = tmp_path / "main.nc", tmp_path / name
    program.write_text(main)
    subprogram.write_text(called)
    run = run_program(program, machine, RunOptions(subprograms=[subprogram]))
    (stop,) = (event for event in run.events if event.kind == "stop")
    assert (Path(run.files[stop.file]).name, stop.line) == ("main.nc", 2)
