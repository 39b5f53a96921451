"""Cures of messages about batches that go on, or find something in their places."""

from typing import Final

from tests.support.cures.scripts import looked_at, script

_MADE: Final = "mkdir in\ncp part.mpf in/a.mpf\n"
_ON: Final = "--machine yl569 --results out"
_RUN: Final = f"trunnion batch in --action verify {_ON}"
_FOLDER: Final = f"{_MADE}{_RUN}"
_TURNED: Final = f"mkdir in\ncp part.cls in/part.cls\ntrunnion batch in --action post {_ON}"
_OTHER: Final = f"mkdir b\ncp part.cls b/two.cls\n{_TURNED}\ntrunnion batch b --action post {_ON}"
_AGAIN: Final = f"rm in/part.cls\ncp part.cls in/two.cls\ntrunnion batch in --action post {_ON}"
_GONE: Final = f"{_TURNED}\nappend out/part.mpf ours\n{_AGAIN}"
_WORKERS: Final = (
    "(lambda each: (each.__enter__(), each.__exit__()))(resolve_name('trunnion.batch.local:LocalWorkers')(1, print))"
)
_URL: Final = f"{_FOLDER[:-3]}memory://a"
_PIPE: Final = "fsspec.implementations.memory.MemoryFileSystem"

CURES: Final = (
    script(
        "BAT120 more_files",
        f"set trunnion.batch.jobs.MOST_FILES 1\n{_MADE}cp part.mpf in/b.mpf\n{_RUN}",
        "cp part.mpf in/b.mpf",
        f"mkdir b\ncp part.mpf b/b.mpf\n{_RUN.replace('batch in', 'batch b')[:-3]}other",
    ),
    script(
        "BAT130 does_not_give",
        f"set trunnion.batch.stores.UrlStore.read 'lambda self, name: None'\n{_URL}",
        "memory://a",
        "out",
    ),
    script("BAT130 does_not_take", f"fails {_PIPE}.pipe_file ENOSPC\n{_URL}", f"fails {_PIPE}.pipe_file ENOSPC\n", ""),
    script(
        "BAT130 does_not_take_results",
        f"fails {_PIPE}.pipe_file EACCES\n{_URL}",
        f"fails {_PIPE}.pipe_file EACCES\n",
        "",
    ),
    script(
        "BAT320 place_taken",
        f"mkdir out\nwrite out/part.mpf ours\n{_TURNED}",
        "trunnion",
        "mv out/part.mpf b.mpf\ntrunnion",
    ),
    script("BAT320 place_taken", f"mkdir out\nwrite out/part.mpf ours\n{_TURNED}", "--results out", "--results b"),
    script("BAT320 result_would_cannot", f"mkdir out/part.mpf\n{_TURNED}", "trunnion", "mv out/part.mpf b\ntrunnion"),
    script("BAT320 result_would_cannot", f"mkdir out/part.mpf\n{_TURNED}", "--results out", "--results b"),
    looked_at("BAT360 ", f"{_TURNED}\n{_AGAIN}"),
    script("BAT370 results_file_another", _OTHER, f"batch b --action post {_ON}", f"batch b --action post {_ON}2"),
    script("BAT370 stays_although_no", _GONE, "rm in/part.cls", "rm out/part.mpf\nrm in/part.cls"),
    script("BAT390 folder_temporary_files", f"set tempfile.tempdir '\"gone\"'\n{_WORKERS}", "gone", "."),
    script(
        "BAT390 work_could_not",
        f"fails trunnion.batch.processing._lay_out EIO\n{_FOLDER}",
        "fails trunnion.batch.processing._lay_out EIO\n",
        "",
    ),
)
