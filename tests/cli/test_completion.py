"""``trunnion completion``: what shells complete, tried in those that are here."""

import shutil
import subprocess
from pathlib import Path

import pytest

from trunnion.cli import main
from trunnion.cli.completion import SCRIPTS
from trunnion.jobs.registry import JOBS

BASH = shutil.which("bash")

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
