"""``trunnion record`` on a twin that runs the golden program of the blade at 50 times its speed."""

import asyncio
import csv
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from asyncua import Client, ua

from tests.support.locations import ROOT
from tests.support.recordings import IMPELLER, impeller
from tests.support.twins import BLADE_FINISH, served
from trunnion import read_program, verify
from trunnion.cli import main
from trunnion.jobs.twin.serving import add_twin_user
from trunnion.model.recording import Mark, Recording
from trunnion.twin.recording.reading import read_recording

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Ctrl-C cannot be sent to a process alone on Windows")


def started(address: str, output: Path) -> subprocess.Popen[str]:
    """A recorder that is recording."""
    command = [sys.executable, "-m", "trunnion", "record", address, "--nodes", "cnc", "--output", str(output)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, encoding="utf-8"
    )
    assert process.stderr is not None
    wait_for(process, "Ctrl-C ends it")
    return process


def wait_for(process: subprocess.Popen[str], words: str) -> None:
    assert process.stderr is not None
    told = []
    for line in process.stderr:
        told.append(line)
        if words in line:
            return
    raise AssertionError("".join(told))


def wait_for_last_motion(journal: Path, recorder: subprocess.Popen[str]) -> None:
    """Wait until the last motion has been written: what is not sent before the server ends, nobody can record."""
    last = float(read_program(BLADE_FINISH, machine="yl569").line[-1])
    while recorder.poll() is None:
        with journal.open(encoding="utf-8", newline="") as file:
            rows = (row for row in csv.DictReader(file) if row["program"].endswith(BLADE_FINISH.name))
            if any(row["line"] and float(row["line"]) >= last for row in rows):
                return
        time.sleep(0.1)
    raise AssertionError("the recorder has ended")


async def run_program(address: str) -> None:
    """Run the program of a twin to its end."""
    async with Client(address, timeout=120) as client:
        index = await client.get_namespace_index("urn:trunnion:twin")
        twin = client.get_node(ua.NodeId("Twin", index))
        state = client.get_node(ua.NodeId("Twin.State", index))
        await twin.call_method(ua.NodeId("Twin.Start", index))
        while await state.read_value() != "ended":
            await asyncio.sleep(0.1)


@pytest.fixture(scope="module")
def recording_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program as it ran; then its server was killed, and another one came to its place."""
    file = tmp_path_factory.mktemp("recorded") / "blade.parquet"
    with served(BLADE_FINISH, "--speed", "50", "--hold", "--no-mtconnect") as twin:
        recorder = started(twin.opcua, file)
        asyncio.run(run_program(twin.opcua))
        wait_for_last_motion(file.with_name("blade.parquet.csv"), recorder)
        twin.process.kill()
    wait_for(recorder, "the connection is broken")
    port = twin.opcua.rpartition(":")[2].partition("/")[0]
    with served(BLADE_FINISH, "--speed", "50", "--hold", "--no-mtconnect", "--port", port):
        wait_for(recorder, "connected again")
        recorder.send_signal(signal.SIGINT)
        said, _ = recorder.communicate()
    assert recorder.returncode == 0
    assert "1 gap marked" in said
    assert not file.with_name("blade.parquet.csv").exists()
    return file


@pytest.fixture(scope="module")
def recording(recording_file: Path) -> Recording:
    return read_recording(recording_file)


def test_every_position_is_on_the_path_of_the_program(recording: Recording) -> None:
    found = verify(BLADE_FINISH, machine="yl569", recorded=recording, recorded_tolerance=1e-6)
    compared, check = found.recorded, found.checks[-1]
    assert compared is not None
    assert (check.key, check.passed) == ("recorded", True), check.summary
    at = compared.compared
    assert compared.tip_off[at].max() < 1e-9
    assert compared.axis_off[at].max() < 1e-9
    assert (compared.positions > 0)[compared.moves].all()
    assert [marks for marks in recording.marks.values() if Mark.GAP in marks] == [(Mark.GAP,)]
    assert np.nanmax(recording.values["spindle"]) == 2500.0


def test_an_axis_that_was_off_fails_with_its_block(
    recording_file: Path, recording: Recording, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = recording.values["line"]
    line = float(np.unique(lines[np.isfinite(lines)])[-40])
    x = recording.values["X"] + np.where(lines == line, 0.2, 0.0)
    file = tmp_path / "off.csv"
    columns = ["source", "X", "Y", "Z", "B", "C", "line"]
    rows = zip(x, *(recording.values[name] for name in columns[2:]), strict=True)
    cells = [",".join(["2026-05-04T08:30:00Z", *("" if np.isnan(each) else repr(float(each)) for each in row)])
             for row in rows]  # fmt: skip
    file.write_text("\n".join([",".join(columns), *cells, ""]), encoding="utf-8")
    code = main(["verify", str(BLADE_FINISH), "--machine", "yl569", "--recorded", str(file)])
    out = capsys.readouterr().out
    number = BLADE_FINISH.read_text(encoding="utf-8").splitlines()[int(line) - 1].split()[0]
    assert code == 1
    # The nearest place of the path is not where the machine should have been then: it is off by a little less.
    assert re.search(
        rf"^recorded +FAIL  {number}: the machine was 0\.(1[5-9]\d\d|2000) mm off the path", out, re.MULTILINE
    )
    assert out.count("the machine was") == 2  # the check, and its one place
    assert f"({number}): the machine was" in out
    assert main(["verify", str(BLADE_FINISH), "--machine", "yl569", "--recorded", str(file),
                 "--recorded-tolerance", "0.3"]) == 0  # fmt: skip
    assert main(["verify", str(BLADE_FINISH), "--machine", "yl569", "--recorded", str(recording_file)]) == 0


@pytest.mark.nightly
def test_one_recording_over_all_programs_of_a_part_is_in_the_report(tmp_path: Path) -> None:
    main_program, file, report = impeller(tmp_path), tmp_path / "impeller.csv", tmp_path / "impeller.json"
    files = [
        "--subprograms",
        *(str(program) for program, _ in IMPELLER.values()),
        "--zero",
        "0,0,0",
        "--tool-length",
        "150",
    ]
    with served(main_program, *files, "--speed", "200", "--hold", "--no-mtconnect") as twin:
        recorder = started(twin.opcua, file)
        asyncio.run(run_program(twin.opcua))
        wait_for_last_motion(file, recorder)
        recorder.send_signal(signal.SIGINT)
        recorder.communicate()
    named = [argument for _, cl in IMPELLER.values() for argument in ("--cl", str(cl))]
    verified = ["verify", str(main_program), "--machine", "yl569", *files, *named, "--recorded", str(file)]
    assert main([*verified, "--report", str(report)]) == 0
    told = json.loads(report.read_text(encoding="utf-8"))
    assert [each["name"] for each in told["operations"]] == ["CAVITY_MILL", "MULTI_BLADE_ROUGH", "BLADE_FINISH"]
    assert all(count or rest for count, rest in zip(told["columns"]["recorded_positions"], rests(told), strict=True))
    used = {each["name"]: each for each in told["recorded"]["extents"]}
    assert used["X"]["limits"] == [-250.0, 250.0]
    assert used["X"]["margin"] == pytest.approx(188.700, abs=1e-3)
    assert used["Spindle"]["whole"]["high"] == 2500.0


def rests(report: dict[str, Any]) -> list[bool]:
    """Which motions of a report move no axis."""
    columns = [values for name, values in report["columns"].items() if name.startswith("axis ")]
    before = [(values[:1] + values[:-1]) for values in columns]
    return [
        values == earlier for values, earlier in zip(zip(*columns, strict=True), zip(*before, strict=True), strict=True)
    ]


def test_a_recording_is_never_written_over(recording_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = recording_file.read_bytes()
    assert main(["record", "opc.tcp://127.0.0.1:1/", "--output", str(recording_file)]) == 2
    assert "never written over" in capsys.readouterr().err
    assert recording_file.read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["http://x/"], "write opc.tcp://HOST:PORT"),
        (["opc.tcp://me:secret@x/"], "has a user in it"),
        (["opc.tcp://x/", "--user", "me"], "needs a channel that is encrypted; add --secure"),
        (["opc.tcp://x/", "--nodes", "sinumerick"], 'did you mean "sinumerik"?'),
        (["opc.tcp://127.0.0.1:1/"], "cannot be connected to"),
    ],
)
def test_what_cannot_be_recorded_is_told(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setattr("trunnion.cli.record.machine_password", lambda _user: "")
    assert main(["record", *arguments, "--output", str(tmp_path / "a.csv")]) == 2
    assert message in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_machine_off_this_computer_is_recorded_by_a_user_who_trusts_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    users, output = tmp_path / "users", tmp_path / "a.csv"
    add_twin_user("ada", "correct horse", operator=False, users=users)
    for name in ("XDG_DATA_HOME", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(tmp_path))
    options = ("--host", "0.0.0.0", "--users", str(users), "--hold", "--no-mtconnect")
    with served(BLADE_FINISH, *options, home=tmp_path / "server") as twin:
        address = twin.opcua.replace("0.0.0.0", "127.0.0.1")
        command = ["record", address, "--output", str(output), "--seconds", "1", "--secure"]
        assert main(command) == 2
        found = re.search(r"--trust ([0-9A-F]{40})", capsys.readouterr().err)
        assert found is not None
        assert main([*command, "--trust", "00" * 20]) == 2
        assert main([*command, "--trust", found[1]]) == 2  # nobody
        assert main([*command[:-1], "--trust", found[1]]) == 2  # the channel is not encrypted
        for password, code in (("wrong horse", 2), ("correct horse", 0)):
            monkeypatch.setattr("sys.stdin", io.StringIO(password + "\n"))
            assert main([*command, "--trust", found[1], "--user", "ada"]) == code
        assert len(read_recording(output)) > 0
        out, err = capsys.readouterr()
        assert "horse" not in out + err
