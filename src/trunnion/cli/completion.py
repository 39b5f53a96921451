"""``trunnion completion``: what makes a shell complete commands, options and their words, from the registry.

The words of ``trunnion explain`` are its codes, those of ``--set`` the settings of all shipped controls.
"""

from collections.abc import Iterator
from functools import cache
from typing import Final

from trunnion.cli.printing import print_result
from trunnion.explanations import explanations
from trunnion.jobs.describe.controls import describe_controls
from trunnion.jobs.job import Given, Job
from trunnion.jobs.registry import JOBS
from trunnion.machines import shipped_machines
from trunnion.options.kinds import Choice, FileIn, FileOut, Setting, Switch
from trunnion.options.option import Option

#: What leads to definitions of machines, which have names too.
_MACHINES: Final = frozenset({"machine", "machines", "definition"})

#: The argument that takes codes of messages.
_CODES: Final = "codes"


def run(given: Given) -> int:
    """Print the script of a shell."""
    print_result(SCRIPTS[given.shell](), end="")
    return 0


@cache
def _settings() -> list[str]:
    """Return what begins a setting of any shipped control."""
    controls = describe_controls()
    return sorted({f"{each.name}=" for control in controls for each in (*control.settings, *control.run_settings)})


def _words(option: Option) -> list[str]:
    """Words that an option takes, as far as they are known."""
    if isinstance(option.kind, Choice):
        return list(option.kind.words)
    if isinstance(option.kind, Setting):
        return _settings()
    if option.name == _CODES:
        return list(explanations())
    return shipped_machines() if isinstance(option.kind, FileIn) and option.kind.leads in _MACHINES else []


def _takes_file(option: Option) -> bool:
    return isinstance(option.kind, FileIn | FileOut)


def _flags(job: Job) -> str:
    return " ".join([*(each.flag for each in job.flags), "--help"])


def _argument_words(job: Job) -> str:
    return " ".join(word for each in job.arguments for word in _words(each))


def bash() -> str:
    """Return a function for bash's ``complete``."""
    return "\n".join(_bash_lines()) + "\n"


def _bash_lines() -> Iterator[str]:
    yield "_trunnion() {"
    yield '    local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}" flags="" words="" files=1'
    yield '    if [ "$COMP_CWORD" -eq 1 ]; then'
    yield f'        COMPREPLY=($(compgen -W "{" ".join(JOBS)} --help --version" -- "$word"))'
    yield "        return"
    yield "    fi"
    yield '    case "${COMP_WORDS[1]}" in'
    for job in JOBS.values():
        files = "" if any(map(_takes_file, job.arguments)) else " files="
        yield f'        {job.name}) flags="{_flags(job)}" words="{_argument_words(job)}"{files} ;;'
    yield "    esac"
    yield '    case "${COMP_WORDS[1]} $before" in'
    for job in JOBS.values():
        for each in job.flags:
            if not isinstance(each.kind, Switch):
                files = "files=1" if _takes_file(each) else "files="
                yield f'        "{job.name} {each.flag}") words="{" ".join(_words(each))}" flags="" {files} ;;'
    yield "    esac"
    yield '    case "$word" in'
    yield '        -*) COMPREPLY=($(compgen -W "$flags" -- "$word")) ;;'
    yield '        *) COMPREPLY=($(compgen -W "$words" -- "$word"))'
    yield '           [ -n "$files" ] && COMPREPLY+=($(compgen -f -- "$word")) ;;'
    yield "    esac"
    yield '    case "${COMPREPLY[0]}" in *=) compopt -o nospace 2>/dev/null ;; esac'
    yield "    return 0"
    yield "}"
    yield "complete -o filenames -F _trunnion trunnion"


def zsh() -> str:
    """Return the same for zsh, which knows what bash has."""
    return f"autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n{bash()}"


def fish() -> str:
    """Lines of fish's ``complete``."""
    return "\n".join(_fish_lines()) + "\n"


def _fish_lines() -> Iterator[str]:
    for job in JOBS.values():
        yield f"complete -c trunnion -f -n __fish_use_subcommand -a {job.name} -d {_quoted(job.title)}"
        here = f"complete -c trunnion -n '__fish_seen_subcommand_from {job.name}'"
        if words := _argument_words(job):
            yield f"{here} -a {_quoted(words)}"
        for each in job.flags:
            value = "" if isinstance(each.kind, Switch) else " -r" if _takes_file(each) else " -x"
            words = " ".join(_words(each))
            listed = f" -a {_quoted(words)}" if words else ""
            yield f"{here} -l {each.flag[2:]}{value}{listed} -d {_quoted(each.help)}"


def _quoted(text: str) -> str:
    """Return a text in single quotes, as fish reads it."""
    escaped = text.replace("\\", "\\\\").replace("'", "\\'")
    return f"'{escaped}'"


def powershell() -> str:
    """Return a completer for PowerShell."""
    return "\n".join(_powershell_lines()) + "\n"


def _powershell_lines() -> Iterator[str]:
    yield "Register-ArgumentCompleter -Native -CommandName trunnion -ScriptBlock {"
    yield "    param($word, $line, $position)"
    yield "    $said = @($line.CommandElements | ForEach-Object { $_.ToString() })"
    yield "    $flags = @{"
    for job in JOBS.values():
        yield f"        '{job.name}' = '{_flags(job)} {_argument_words(job)}'"
    yield "    }"
    yield "    $values = @{"
    for job in JOBS.values():
        for each in job.flags:
            if words := _words(each):
                yield f"        '{job.name} {each.flag}' = '{' '.join(words)}'"
    yield "    }"
    yield "    $before = if ($word) { $said[-2] } else { $said[-1] }"
    yield "    $found = if ($said.Count -le 1 -or ($said.Count -eq 2 -and $word)) { $flags.Keys }"
    yield '        elseif ($values.ContainsKey("$($said[1]) $before")) { $values["$($said[1]) $before"] -split " " }'
    yield '        elseif ($flags.ContainsKey($said[1])) { $flags[$said[1]] -split " " }'
    yield '    $found | Where-Object { $_ -like "$word*" } | Sort-Object | ForEach-Object {'
    yield '        [System.Management.Automation.CompletionResult]::new($_, $_, "ParameterValue", $_)'
    yield "    }"
    yield "}"


#: What makes the script of each shell.
SCRIPTS: Final = {"bash": bash, "zsh": zsh, "fish": fish, "powershell": powershell}
