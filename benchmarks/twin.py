"""A twin under load: ``python benchmarks/twin.py [--clients 20] [--items 200] [--seconds 120]``.

A golden five-axis program runs at its own speed, in a loop, with a sample each 50 ms. Clients of others (node-opcua,
``npm ci`` in ``tests/twin/node``) subscribe to as many items at 50 ms each. Prints how many values were told, how many
any client missed that another had, or the history of an axis has or has not, and the memory of the server while it went
on. Exit code 1 if a value was missed, or memory grew by more than a twentieth after the first quarter.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "tests" / "golden" / "yl569" / "3_blade_finish.expected.mpf"
MODULES = ROOT / "tests" / "twin" / "node"
INTERVAL = 50


def resident(process: int) -> tuple[float, float]:
    """Memory of a process, MB, and the processor seconds that it has used (Linux)."""
    status = Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    times = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(found[1]) / 1000.0 if found else 0.0), (int(times[11]) + int(times[12])) / 100.0


def serve() -> tuple[subprocess.Popen[str], str]:
    """Return the twin, and its address."""
    command = [sys.executable, "-m", "trunnion", "twin", str(PROGRAM), "--machine", "yl569", "--loop"]
    command += ["--rate", str(INTERVAL), "--port", "0", "--no-mtconnect"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    for line in process.stderr:
        if found := re.search(r"opc\.tcp://\S+", line):
            return process, found[0]
    sys.exit("the twin was not served")


def main() -> int:
    """Run it, and judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("clients", 20), ("items", 200), ("seconds", 120)):
        parser.add_argument(f"--{name}", type=int, default=value)
    asked = parser.parse_args()
    process, address = serve()
    memory: list[tuple[float, float]] = []
    ended = threading.Event()

    def watch() -> None:
        while not ended.wait(1.0):
            memory.append(resident(process.pid))

    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "result.json"
        sizes = [str(each) for each in (asked.clients, asked.items, INTERVAL, asked.seconds)]
        command = ["node", str(ROOT / "benchmarks" / "twin_clients.js"), address, *sizes, str(MODULES), str(result)]
        watching = threading.Thread(target=watch)
        watching.start()
        begun = time.monotonic()
        done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL)
        lasted = time.monotonic() - begun
        ended.set()
        watching.join()
        process.terminate()
        process.communicate()
        if done.returncode:
            return 1
        found = json.loads(result.read_text(encoding="utf-8"))
    sizes_of = [megabytes for megabytes, _ in memory[len(memory) // 4 : -3]]
    processor = (memory[-1][1] - memory[0][1]) / lasted
    print(f"{asked.clients} clients with {asked.items} items at {INTERVAL} ms for {found['seconds']:.0f} s")
    print(f"values told          {found['values']:>12,}   {found['values'] / found['seconds']:,.0f} in a second")
    print(f"missed by a client   {found['missed']:>12,}   of what another was told")
    print(f"missed of history    {found['behind']:>12,}   of {found['compared']:,} values, or not in it")
    print(f"lost in queues       {found['lost']:>12,}")
    print(f"times told           {found['stamps']:>12,}   {found['stamps'] / found['seconds']:.1f} in a second")
    print(f"memory of the server {sizes_of[0]:>10.1f} MB   after a quarter, {sizes_of[-1]:.1f} MB at the end")
    print("MB each 10 s         ", " ".join(f"{each:.0f}" for each, _ in memory[::10]))
    print(f"its processor        {processor:>10.2f}      of one")
    grew = sizes_of[-1] > 1.05 * sizes_of[0]
    return int(
        not found["values"]
        or not found["compared"]
        or bool(found["missed"] or found["behind"] or found["lost"] or grew)
    )


if __name__ == "__main__":
    sys.exit(main())
