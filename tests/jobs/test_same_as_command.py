"""The library gives what the commands give, byte for byte: programs, CL files, reports, checks and differences.

Its messages differ by nothing but the names of arguments, which the commands translate.
"""

import io
from dataclasses import dataclass
from pathlib import Path

import pytest

import trunnion
from tests.support.golden_controls import CASES as CONTROL_CASES
from tests.support.locations import FIDIA, FIDIA_HEAD, GOLDEN, HEADS, YL569
from trunnion.cli import main
from trunnion.cli.wording import in_command_words, problem_line
from trunnion.verification import check_lines, place_lines, stand_lines, time_lines

Capture = pytest.CaptureFixture[bytes]


@dataclass(frozen=True)
class Case:
    """A golden CL file, posted for a machine."""

    cl: Path
    machine: str
    settings: dict[str, str]


CASES = {
    **{
        f"yl569 {name}": Case(YL569 / f"{name}.cls", "yl569", HEADS.get(name, {}))
        for name in ("1_contour_rough", "2_hub_rough", "3_blade_finish")
    },
    **{
        name: Case(
            GOLDEN / case.cl,
            str(GOLDEN / case.machine) if case.machine.endswith(".toml") else case.machine,
            dict(setting.split("=", 1) for setting in case.settings),
        )
        for name, case in CONTROL_CASES.items()
    },
    "hs664rt": Case(FIDIA / "radial_holes.cls", "hs664rt", FIDIA_HEAD),
    "dmu65 corner": Case(GOLDEN / "dmu65" / "corner.cls", "dmu65", {}),
    "dmu65 bevel": Case(GOLDEN / "dmu65" / "bevel.cls", "dmu65", {}),
    "blade on dmu65": Case(YL569 / "3_blade_finish.cls", "dmu65", {"tcp": "off", "zero": "0,0,120"}),
}


def options(settings: dict[str, str]) -> list[str]:
    return [f"--set={key}={value}" for key, value in settings.items()]


@pytest.mark.third
@pytest.mark.parametrize("name", CASES)
def test_a_program_is_the_same_and_so_is_its_proof(name: str, tmp_path: Path, capfdbinary: Capture) -> None:
    case = CASES[name]
    command = ["post", str(case.cl), "--machine", case.machine, *options(case.settings)]
    code = main([*command, "--output", "-", "--explain"])
    out, err = capfdbinary.readouterr()
    stream = io.BytesIO()
    result = trunnion.post(
        case.cl, machine=case.machine, output=stream, settings=case.settings, explain=True, columns=False
    )
    assert (code, result.passed) == (0, True)
    assert stream.getvalue() == out
    assert result.verification is not None
    assert result.standing is not None
    remarks = [problem_line(remark) for toolpath in result.toolpaths for remark in toolpath.remarks]
    others = [problem_line(problem) for problem in result.problems][len(remarks) :]
    decisions = [in_command_words(str(decision)) for decision in result.decisions]
    found = result.verification
    proof = [
        *check_lines(found),
        *place_lines(found, failed_only=True),
        *stand_lines(found.checks),
        result.standing.told,
    ]
    printed = err.decode().splitlines()
    assert printed[: len(remarks) + len(decisions)] == [*remarks, *(decisions or [""])][: len(remarks) + len(decisions)]
    assert [line for line in printed if line][len(remarks) + len(decisions) :] == [*others, *proof]


@pytest.mark.parametrize("name", ["yl569 3_blade_finish", "fanuc/flange.expected.nc", "hs664rt"])
@pytest.mark.parametrize("suffix", [".html", ".json"])
def test_a_report_is_the_same(name: str, suffix: str, tmp_path: Path, capfdbinary: Capture) -> None:
    case = CASES[name]
    target, one, two = tmp_path / "p.nc", tmp_path / f"one{suffix}", tmp_path / f"two{suffix}"
    command = ["post", str(case.cl), "--machine", case.machine, "--output", str(target), *options(case.settings)]
    assert main([*command, "--report", str(one)]) == 0
    result = trunnion.post(case.cl, machine=case.machine, output=target, settings=case.settings, explain=True)
    result.write_report(two)
    assert one.read_bytes() == two.read_bytes()
    capfdbinary.readouterr()


@pytest.mark.parametrize("with_cl", [True, False])
def test_a_verification_is_the_same(with_cl: bool, capfdbinary: Capture) -> None:
    cl, program = YL569 / "3_blade_finish.cls", YL569 / "3_blade_finish.expected.mpf"
    command = ["verify", str(program), "--machine", "yl569", "--span", "1", *(["--cl", str(cl)] if with_cl else [])]
    code = main(command)
    found = trunnion.verify(program, machine="yl569", cl=[cl] if with_cl else (), span=1.0, columns=False)
    lines = [
        *check_lines(found),
        *place_lines(found),
        *time_lines(found),
        *stand_lines(found.checks),
        found.standing.told,
    ]
    assert capfdbinary.readouterr().out.decode().splitlines() == lines
    assert (code, found.passed) == (1, False)


@pytest.mark.third
@pytest.mark.parametrize("name", ["1_contour_rough", "2_hub_rough", "3_blade_finish"])
@pytest.mark.parametrize("to_machine", [None, "yl569", "generic_head_head_ca", "dmu65"])
def test_a_conversion_is_the_same(name: str, to_machine: str | None, capfdbinary: Capture) -> None:
    program = YL569 / f"{name}.expected.mpf"
    into = ["--to-cl"] if to_machine is None else ["--to-machine", to_machine]
    code = main(["convert", str(program), "--machine", "yl569", *into, "--output", "-"])
    out = capfdbinary.readouterr().out
    converted = trunnion.convert(program, machine="yl569", to_machine=to_machine, to_cl=to_machine is None)
    assert code == 0
    assert converted.text is not None
    assert converted.text.encode() == out


def test_a_comparison_is_the_same(tmp_path: Path, capfdbinary: Capture) -> None:
    program, other = YL569 / "3_blade_finish.expected.mpf", tmp_path / "other.mpf"
    other.write_bytes(program.read_bytes().replace(b"X47.2619 ", b"X47.3619 "))
    for second in (program, other):
        code = main(["diff", str(program), str(second), "--machine", "yl569"])
        found = trunnion.diff(program, second, machine="yl569")
        assert capfdbinary.readouterr().out.decode().splitlines() == list(found.lines())
        assert found.same is (code == 0)
