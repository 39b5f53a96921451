"""The JSON of one job of each command that gives a result as data.

``python -m tests.support.frozen_results`` writes ``tests/golden/results`` anew, with ``OLD NEW`` it prints what differs
between the JSON of two checkouts, byte for byte; names of jobs behind that choose some.
"""

import contextlib
import difflib
import io
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FROZEN = ROOT / "tests/golden/results"

HUB, BLADE, CONTOUR = (f"golden/yl569/{name}.cls" for name in ("2_hub_rough", "3_blade_finish", "1_contour_rough"))
HUB_MPF = "golden/yl569/2_hub_rough.expected.mpf"
COLLISIONS = ("--turns", "90", "--goal", "collisions")
SET = ("--set", "zero=-30,0,-80", "--set", "tool_length=120")
ZERO = ("--zero=-30,0,-80", "--tool-length=120")
TO_JSON = ("--json", "{}")
PLATE = "examples/simulation/plate.stl"
STOCK = ("--stock", "box:100,80,30,-50,-40,-30", "--cell", "1")
TOOLS = ("--tool", "1=flat:16,length=60,holder=40x50", "--tool", "2=flat:8,length=50", "--near", "5")

#: Each job by its name: the arguments, of which ``{}`` is the file that it writes; without one it prints its data.
JOBS: dict[str, tuple[str, ...]] = {
    "post": ("post", HUB, "--machine", "yl569", *SET, "--output", "hub.mpf", "--report", "{}"),
    "post_force": ("post", "lean.cls", "--machine", "yl569", "--force", "--output", "lean.mpf", "--report", "{}"),
    "sheet": ("post", HUB, BLADE, "--machine", "yl569", *SET, "--output", "sheet.mpf", "--sheet", "{}"),
    "manifest": ("post", HUB, "--machine", "yl569", "--output", "listed.mpf", "--manifest", "{}"),
    "post_simulated": (
        "post", "examples/project/plate_top.cls", "--machine", "yl569", "--output", "plate.mpf", "--simulate", *STOCK,
        *TOOLS, "--report", "{}",
    ),
    "verify": ("verify", HUB_MPF, "--machine", "yl569", "--cl", HUB, "--report", "{}"),
    "verify_failed": ("verify", HUB_MPF, "--machine", "yl569", "--cl", CONTOUR, "--report", "{}"),
    "simulate": (
        "simulate", "examples/simulation/plate_top.mpf", "--machine", "yl569", *STOCK, *TOOLS, "--part",
        PLATE, "--json", "{}",
    ),
    "simulate_project": ("simulate", "examples/simulation/plate.toml", "--cell", "1", "--json", "{}"),
    "place": ("place", HUB, "--machine", "yl569", "--turns", "90", "--tool-length", "120", "--json", "{}"),
    "place_time": ("place", HUB_MPF, "--machine", "yl569", "--turns", "90", "--goal", "time", *ZERO, "--json", "{}"),
    "place_project": ("place", "examples/project/part.toml", "--setup", "top", *COLLISIONS, "--json", "{}"),
    "place_nowhere": ("place", "lean.cls", "--machine", "yl569", "--turns", "90", "--json", "{}"),
    "reach": ("reach", HUB, "--machine", "yl569", *ZERO, "--step", "30", "--json", "{}"),
    "reach_part": ("reach", "--machine", "mikron_600u", "--part", PLATE, "--step", "45", "--json", "{}"),
    "sensitivity": ("sensitivity", HUB_MPF, "--machine", "yl569", *ZERO, "--json", "{}"),
    "sensitivity_home": ("sensitivity", HUB_MPF, "--machine", "yl569", "--zero-at", "home", "--json", "{}"),
    "kinematics": ("kinematics", "generic_nutated_b45_c", "--json", "{}"),
    "fit": ("fit", HUB, "--machines", "yl569,mikron_600u,dmu65", "--json", "{}"),
    "info": ("info", HUB, BLADE, "--json"),
    "info_unknown": ("info", "unknown.cls", "--json"),
    "curve": ("curve", "examples/impeller/blade_points.csv", "--json"),
    "impeller_model": ("impeller", "model", "examples/impeller/impeller.toml", "--tolerance", "0.1", "--json"),
    "batch": ("batch", "examples/batch/jobs.toml", "--workers", "1"),
    "posted": ("post", HUB, "--machine", "yl569", "--output", "posted.mpf", "--manifest", "listed.json", *TO_JSON),
    "diff": ("diff", HUB_MPF, "golden/yl569/3_blade_finish.expected.mpf", "--machine", "yl569", "--json", "{}"),
    "convert": ("convert", HUB_MPF, "--machine", "yl569", "--to-machine", "mikron_600u", "--output", "c.h", *TO_JSON),
    "convert_to_cl": ("convert", HUB_MPF, "--machine", "yl569", "--to-cl", "--output", "c.cls", *TO_JSON),
    "manifest_check": ("verify", "listed.json", "--json", "{}"),
    "survey": ("survey", "pile", "--machine", "yl569", "--workers", "1", "--json", "{}"),
    "machines": ("machines", "--json"),
    "controls": ("controls", "--json"),
    "control": ("controls", "sinumerik_840d", "--json"),
    "check": ("check", "examples/machines/mori_nmv.toml", "--json"),
    "explain": ("explain", "CL110", "NC110", "tip", "--json"),
}  # fmt: skip

#: Seconds that computing took.
_TIMES = re.compile(r'^( )"seconds": [0-9.e+-]+$', re.MULTILINE)

#: So many items of a list are kept: columns have one for each motion.
_MOST = 30


def lay_out(folder: Path) -> None:
    """Copy what the jobs read into a folder."""
    shutil.copytree(ROOT / "tests/golden", folder / "golden", ignore=shutil.ignore_patterns("results"))
    shutil.copytree(ROOT / "examples", folder / "examples")
    text = (ROOT / HUB.replace("golden", "tests/golden", 1)).read_text(encoding="utf-8")
    first = text.index("GOTO/")
    (folder / "lean.cls").write_text(
        text[:first] + re.sub(r"(GOTO/[^,]+,[^,]+,[^,\n]+)[^\n]*", r"\1,0.0,0.7071068,-0.7071068", text[first:]),
        encoding="utf-8",
    )
    (folder / "pile").mkdir()
    for file in (HUB, HUB_MPF):
        shutil.copy(folder / file, folder / "pile")
    shutil.copy(ROOT / "tests/data/kinds/lathe.nc", folder / "pile")
    (folder / "pile" / "calls.mpf").write_text("N1 G0 X1\nFOO(3)\nM30\n", encoding="utf-8")
    (folder / "unknown.cls").write_text(text.replace("RAPID\n", "RAPID\nUNHEARD/1\nDISPLAY/ON\n", 1), encoding="utf-8")


def data_of(arguments: tuple[str, ...]) -> str:
    """Run a job in this process, in the working folder; its JSON."""
    from trunnion.cli import main

    target, out = Path("result.json"), io.StringIO()
    target.unlink(missing_ok=True)
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()) as told:
        main([each.replace("{}", str(target)) for each in arguments])
    if arguments[0] == "batch":
        text = _records(Path(arguments[1]).parent)
    else:
        text = target.read_text(encoding="utf-8") if "{}" in arguments else out.getvalue()
    assert text, told.getvalue()
    return _TIMES.sub(r'\1"seconds": 0.0', text) if arguments[0] == "simulate" else text


def _records(folder: Path) -> str:
    """What is kept of the files of a batch, without what depends on the version."""
    found = [json.loads(file.read_text("utf-8").split("\n")[0]) for file in folder.rglob(".trunnion-batch/*/*.json")]
    known = [{key: value for key, value in each.items() if key not in ("key", "outputs")} for each in found]
    return json.dumps(sorted(known, key=lambda each: str(each["place"])), ensure_ascii=False, indent=1)


def shortened(value: Any) -> Any:
    """Data without the rest of long lists."""
    if isinstance(value, dict):
        return {key: shortened(each) for key, each in value.items()}
    return [shortened(each) for each in value[:_MOST]] if isinstance(value, list) else value


def differences(old: Any, new: Any, place: str = "") -> list[str]:
    """Where data differs: in keys, their order, types, texts, and in numbers by more than computers do."""
    if isinstance(old, dict) and isinstance(new, dict) and list(old) == list(new):
        return [text for key in old for text in differences(old[key], new[key], f"{place}.{key}")]
    if isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        pairs = enumerate(zip(old, new, strict=True))
        return [text for k, pair in pairs for text in differences(*pair, f"{place}[{k}]")]
    if type(old) is type(new) is float and math.isclose(old, new, rel_tol=1e-6, abs_tol=1e-6):
        return []
    if place.endswith(".facets") and math.isclose(old, new, rel_tol=1e-3):  # halved where a last digit decides
        return []
    return [] if type(old) is type(new) and old == new else [f"{place}: {old!r} became {new!r}"]


def portable(text: str, *folders: Path | str) -> str:
    """A text without the names of folders."""
    for folder in folders:
        text = text.replace(str(folder), "")
    return text


def _of_checkout(root: Path, names: list[str]) -> dict[str, str]:
    """The JSON of jobs, made by a checkout."""
    lines = "import json, sys\nfrom tests.support.frozen_results import JOBS, data_of, lay_out\n"
    lines += "print(json.dumps({name: data_of(JOBS[name]) for name in sys.argv[1:]}))"
    with tempfile.TemporaryDirectory() as folder:
        lay_out(Path(folder))
        paths = os.pathsep.join(map(str, (root / "src", ROOT)))
        found = subprocess.run(
            [sys.executable, "-c", lines, *names], cwd=folder, stdout=subprocess.PIPE, check=True,
            env={**os.environ, "PYTHONPATH": paths, "PYTHONUTF8": "1"},
        )  # fmt: skip
        return {name: portable(text, folder, root) for name, text in json.loads(found.stdout).items()}


def _compare(old: Path, new: Path, names: list[str]) -> int:
    before, after = _of_checkout(old.resolve(), names), _of_checkout(new.resolve(), names)
    different = [name for name in names if before[name] != after[name]]
    for name in different:
        one, other = before[name].splitlines(), after[name].splitlines()
        print(*difflib.unified_diff(one, other, f"{name} before", f"{name} after", n=1, lineterm=""), sep="\n")
    print(f"{len(names)} results, {len(different)} differ: {', '.join(different) or 'none'}")
    return 1 if different else 0


def write(root: Path, names: list[str]) -> None:
    """Freeze the results of a checkout."""
    FROZEN.mkdir(exist_ok=True)
    for name, text in _of_checkout(root, names).items():
        kept = json.dumps(shortened(json.loads(text)), ensure_ascii=False, indent=1)
        (FROZEN / f"{name}.json").write_text(kept + "\n", encoding="utf-8")


if __name__ == "__main__":
    chosen = [each for each in sys.argv[1:] if each in JOBS]
    checkouts = [Path(each) for each in sys.argv[1:] if each not in JOBS]
    if checkouts:
        old, new = checkouts
        sys.exit(_compare(old, new, chosen or list(JOBS)))
    write(ROOT, chosen or list(JOBS))
