"""A try: tests run in a forked process, with a limit of processor seconds and memory, until one fails."""

import os
import resource
import select
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import hypothesis.strategies
import numba
import pytest

#: Bytes of data of a process: a mutant may never stop to collect.
MEMORY = 3 << 30


def prepare() -> None:
    """Import and set up, once for all tries, what most tests want."""
    numba.njit("int64()")(lambda: 0)
    pytest.main(["--version"])


_COMPILE = """
import importlib, pkgutil, trunnion
from trunnion.jit.kernels import Kernel
for found in pkgutil.walk_packages(trunnion.__path__, "trunnion."):
    if not found.name.endswith("__main__"):
        for each in vars(importlib.import_module(found.name)).values():
            if isinstance(each, Kernel):
                each.prepare()
"""


def compile_kernels(tree: Path) -> None:
    """Compile all kernels of a tree, so that no mutant has to wait for it."""
    environment = {**os.environ, "PYTHONPATH": str(tree / "src"), "PYTHONDONTWRITEBYTECODE": ""}
    subprocess.run([sys.executable, "-c", _COMPILE], check=True, env=environment)


class Watch:
    """A plugin of pytest that says which test begins, and which fails; a property neither shrinks nor remembers.

    seconds  of a processor, after which a test is taken to hang
    """

    def __init__(self, seconds: float) -> None:
        self.say, self.seconds = 1, seconds

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self) -> None:
        """Leave out the search of a simpler example, which takes as long as the tests."""
        phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
        hypothesis.settings.register_profile("mutants", hypothesis.settings(), phases=phases, database=None)
        hypothesis.settings.load_profile("mutants")

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Say which test begins, and let it not take for ever."""
        os.write(self.say, f">{nodeid}\n".encode())
        signal.setitimer(signal.ITIMER_PROF, self.seconds)

    def pytest_collectreport(self, report: pytest.CollectReport | pytest.TestReport) -> None:
        """Say which test fails, or which module cannot be imported."""
        if report.failed:
            os.write(self.say, f"!{report.nodeid}\n".encode())

    pytest_runtest_logreport = pytest_collectreport


def first_failure(tree: Path, tests: Sequence[str], watch: Watch, budget: float) -> tuple[str | None, float]:
    """The first test that fails, hangs or crashes (empty: none does; None: not within the budget), and the seconds."""
    hear, say = os.pipe()
    child = os.fork()
    if child == 0:
        _run(tree, tests, watch, say, budget)
    os.close(say)
    said, end = [""], time.monotonic() + 10.0 * budget + 60.0  # of a test that sleeps for ever
    while not any(line[:1] in "!=" for line in said[:-1]) and (wait := end - time.monotonic()) > 0.0:
        if select.select([hear], [], [], wait)[0]:
            if not (more := os.read(hear, 65536)):
                break
            said = ("\n".join(said) + more.decode(errors="replace")).split("\n")
    else:
        _end_group(child)
    _, status, used = os.wait4(child, 0)
    _end_group(child)
    os.close(hear)
    spent = used.ru_utime + used.ru_stime
    if failed := [line[1:] for line in said if line[:1] == "!"]:
        return failed[0], spent
    if said[-2:-1] in (["=0"], ["=5"]):
        return "", spent
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGKILL, signal.SIGXCPU):
        return None, spent
    return ([line[1:] for line in said if line[:1] == ">"] or list(tests))[-1], spent


def _end_group(child: int) -> None:
    """End a process, and what its tests have left running."""
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)


def _run(tree: Path, tests: Sequence[str], watch: Watch, say: int, budget: float) -> None:
    """Run tests in the forked process, which ends here."""
    try:
        os.setpgid(0, 0)
        silent = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(silent, stream)
        resource.setrlimit(resource.RLIMIT_CPU, (int(budget) + 1, int(budget) + 5))
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        for name in [name for name in sys.modules if name.split(".")[0] in ("tests", "trunnion")]:
            del sys.modules[name]
        paths = [str(tree / "src"), str(tree)]
        sys.path[:] = [*paths, *(path for path in sys.path if path not in paths)]
        os.environ["PYTHONPATH"] = os.pathsep.join(paths)
        sys.dont_write_bytecode, os.environ["PYTHONDONTWRITEBYTECODE"] = False, ""
        os.chdir(tree)
        watch.say = say
        how = ("-x", "--tb=no", "-p", "no:xdist", "--hypothesis-seed=0")
        code = int(pytest.main([*how, *tests], plugins=[watch]))
        if code == pytest.ExitCode.USAGE_ERROR:  # a test has another name: so have all of its module tried
            code = int(pytest.main([*how, *dict.fromkeys(test.partition("::")[0] for test in tests)], plugins=[watch]))
        os.write(say, f"={code}\n".encode())
    finally:
        os._exit(0)
