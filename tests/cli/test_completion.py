"""``trunnion completion``: what shells complete, tried in those that are here."""

import os
import select
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from trunnion.cli import main
from trunnion.cli.completion import SCRIPTS
from trunnion.jobs.registry import JOBS

BASH, ZSH, FISH, PWSH = (shutil.which(shell) for shell in ("bash", "zsh", "fish", "pwsh"))

#: What is typed, and what the shell makes of the last word.
TYPED = {
    ("si",): "simulate",
    ("post", "--mani"): "--manifest",
    ("post", "--feed", "f"): "fastest",
    ("post", "part.cls", "--machine", "dmu6"): "dmu65",
    ("post", "par"): "part.cls",
    ("schema", "proj"): "project",
    ("explain", "CL12"): "CL120",
    ("verify", "--set", "radius_reg"): "radius_register=",
}

#: What parses a script without running it.
PARSERS = {"zsh": ["-n"], "fish": ["--no-execute"]}


def completed(*words: str, folder: Path) -> list[str]:
    """What bash suggests for the last word."""
    script = folder / "completion.bash"
    script.write_text(SCRIPTS["bash"](), encoding="utf-8")
    line = " ".join(f"'{word}'" for word in ("trunnion", *words))
    asked = f"source {script}; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _trunnion"
    asked += "; printf '%s\\n' \"${COMPREPLY[@]}\""
    assert BASH is not None
    done = subprocess.run([BASH, "-c", asked], capture_output=True, text=True, check=True, cwd=folder)
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.skipif(BASH is None, reason="there is no bash")
def test_bash_completes_commands_options_words_and_files(tmp_path: Path) -> None:
    (tmp_path / "part.cls").touch()
    assert completed("si", folder=tmp_path) == ["simulate"]
    assert set(completed("", folder=tmp_path)) == {*JOBS, "--help", "--version"}
    assert completed("post", "--mani", folder=tmp_path) == ["--manifest"]
    assert completed("post", "--feed", "f", folder=tmp_path) == ["fastest"]
    assert "dmu65" in completed("post", "part.cls", "--machine", "dmu", folder=tmp_path)
    assert completed("post", "par", folder=tmp_path) == ["part.cls"]
    assert completed("schema", "proj", folder=tmp_path) == ["project"]
    assert completed("post", "--turn", "", folder=tmp_path) == []
    assert completed("explain", "CL12", folder=tmp_path) == ["CL120"]
    assert completed("verify", "--set", "radius_reg", folder=tmp_path) == ["radius_register="]


@pytest.mark.parametrize("shell", SCRIPTS)
def test_a_script_names_every_option(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    flags = {option.flag.lstrip("-") for job in JOBS.values() for option in job.flags}
    assert [flag for flag in flags if flag not in script] == []


@pytest.mark.parametrize("shell", PARSERS)
def test_a_shell_that_is_here_parses_its_script(shell: str, tmp_path: Path) -> None:
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"there is no {shell}")
    script = tmp_path / "script"
    script.write_text(SCRIPTS[shell](), encoding="utf-8")
    subprocess.run([program, *PARSERS[shell], str(script)], check=True)


@pytest.mark.skipif(FISH is None, reason="there is no fish")
def test_fish_completes_commands_options_words_and_files(tmp_path: Path) -> None:
    (tmp_path / "part.cls").touch()
    script = tmp_path / "trunnion.fish"
    script.write_text(SCRIPTS["fish"](), encoding="utf-8")
    asked = "".join(f"; complete -C 'trunnion {' '.join(words)}'" for words in TYPED)
    assert FISH is not None
    done = subprocess.run(
        [FISH, "-c", f"source {script}{asked}"], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert done.stderr == ""
    assert [line.partition("\t")[0] for line in done.stdout.splitlines()] == list(TYPED.values())


@pytest.mark.skipif(PWSH is None, reason="there is no pwsh")
def test_powershell_completes_commands_options_words_and_files(tmp_path: Path) -> None:
    (tmp_path / "part.cls").touch()
    (tmp_path / "trunnion.ps1").write_text(SCRIPTS["powershell"](), encoding="utf-8")
    lines = [f"trunnion {' '.join(words)}" for words in TYPED]
    asked = "; ".join(f"(TabExpansion2 '{line}' {len(line)}).CompletionMatches[0].CompletionText" for line in lines)
    assert PWSH is not None
    command = [PWSH, "-NoProfile", "-NonInteractive", "-Command", f". ./trunnion.ps1; {asked}"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stderr == ""
    found = [line.removeprefix("./").removeprefix(".\\") for line in done.stdout.splitlines()]
    assert found == list(TYPED.values())


@contextmanager
def terminal(program: str, folder: Path) -> Iterator[int]:
    """A shell at a terminal: the file descriptor of its other end."""
    if sys.platform == "win32":
        pytest.skip("Windows has no such terminals")
    import pty

    process, end = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.execve(program, [program, "-f", "-i"], {**os.environ, "TERM": "dumb", "PS1": "> "})
    try:
        yield end
    finally:
        os.close(end)
        os.waitpid(process, 0)


def until(end: int, text: str) -> str:
    """What a shell shows up to a text."""
    shown = ""
    while text not in shown:
        ready, _, _ = select.select([end], [], [], 60.0)
        assert ready, f"{text!r} never came: {shown!r}"
        shown += os.read(end, 4096).decode()
    return shown


@pytest.mark.skipif(ZSH is None, reason="there is no zsh")
def test_zsh_completes_commands_options_words_and_files(tmp_path: Path) -> None:
    (tmp_path / "part.cls").touch()
    (tmp_path / "trunnion.zsh").write_text(SCRIPTS["zsh"](), encoding="utf-8")
    assert ZSH is not None
    with terminal(ZSH, tmp_path) as end:
        os.write(end, b"source ./trunnion.zsh; echo rea''dy\n")
        until(end, "ready")
        for words, completed_word in TYPED.items():
            os.write(end, f"trunnion {' '.join(words)}\t".encode())
            until(end, " ".join(["trunnion", *words[:-1], completed_word]))
            os.write(end, b"\x15")  # deletes the line
