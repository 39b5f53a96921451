"""Work that takes no time in place of posts, in worker processes too, which import little for it.

What it does stands in the file: ``fail``, ``refuse``, ``several …``, ``die PATH`` (ends its process, unless PATH is
there, and makes it), ``always die``, ``sleep SECONDS``, ``cold PATH SECONDS AGAIN`` (makes PATH and sleeps; where it is
there, AGAIN seconds); anything else passes.

A file that is divided is put together from its shares: ``dies in 1 PATH`` and ``sleeps in 1 SECONDS`` mean share 1, and
``fail`` fails in all of them.
"""

import os
import signal
import time
from pathlib import Path

from trunnion.batch.share_seals import BrokenSealError, unsealed_all
from trunnion.batch.worker_task import SHARE_FILE, Outcome, Status, Task
from trunnion.batch.workers import damaged
from trunnion.errors import Problem
from trunnion.messages import foreign


def simple_work(task: Task) -> Outcome:
    """What stands in the file."""
    text = task.files[task.file].decode()
    word, _, rest = text.partition(" ")
    if task.share is not None and word in ("dies", "sleeps"):
        number, _, rest = rest.removeprefix("in ").partition(" ")
        word = word[:-1] if task.share[0] == int(number) else ""
    if word == "die" and not Path(rest).exists():
        Path(rest).write_text("", encoding="utf-8")
        os.kill(os.getpid(), getattr(signal, "SIGKILL", signal.SIGTERM))
    if text == "always die":
        os.kill(os.getpid(), getattr(signal, "SIGKILL", signal.SIGTERM))
    if word == "cold":
        path, first, again = rest.split()
        is_again = Path(path).exists()
        Path(path).write_text("cold", encoding="utf-8")
        time.sleep(float(again if is_again else first))
    if word == "sleep":
        time.sleep(float(rest))
    if word == "fail":
        return Outcome(Status.UNUSABLE, (Problem(task.file, 3, foreign("is wrong", code="CL310")),))
    if word == "refuse":
        return Outcome(
            Status.FAILED, (Problem(task.file, 0, foreign("must not run", code="tip")),), figures={"points": 2}
        )
    if task.share is not None:
        return Outcome(Status.PASSED, files={SHARE_FILE: f"{task.share} of {text}".encode()})
    if task.shares:
        try:
            shares = unsealed_all(task.shares, task.seals)
        except BrokenSealError as error:
            return Outcome(Status.HINDERED, (damaged(task.file, str(error)),))
        assert shares == [f"({k}, {len(shares)}) of {text}".encode() for k in range(len(shares))]
    files = {task.result: f"of {text}".encode()}
    if word == "several":
        files |= {"SUB1": b"one", "SUB2": b"two"}
    return Outcome(Status.PASSED, files=files, figures={"points": len(text), "tools": ["1"], "seconds": 1.5})
