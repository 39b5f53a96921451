"""Machine code for wheels: ``python -m trunnion.jit.wheel_libraries FOLDER [KERNELS [SYSTEM …]]``.

Leaves in the folder, for each system that a wheel is made for, a folder of libraries as ``trunnion.jit.shipped`` loads
them. All systems are served from any computer: LLVM emits object code for all processors, and the linker of Zig makes
libraries for all systems (extra ``test``). Numba compiles each kernel once for each level of processor: its loops
depend on how many numbers a processor takes at a time.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from llvmlite import binding as llvm

from trunnion.jit.ahead import all_kernels
from trunnion.jit.build import Processor, emitted
from trunnion.jit.library import ENTRY, SYSTEM
from trunnion.jit.shipped import BASE, LEVEL, function_name, library_name


class System(NamedTuple):
    """A system that wheels are made for: what LLVM and the linker call it, and how a library ends there."""

    triple: str
    linked_for: str
    suffix: str
    levels: tuple[int, ...]


#: By what wheels call them.
SYSTEMS: Final = {
    "manylinux_2_17_x86_64": System("x86_64-unknown-linux-gnu", "x86_64-linux-gnu.2.17", ".so", (2, 3)),
    "manylinux_2_17_aarch64": System("aarch64-unknown-linux-gnu", "aarch64-linux-gnu.2.17", ".so", (1,)),
    "win_amd64": System("x86_64-pc-windows-gnu", "x86_64-windows-gnu", ".dll", (2, 3)),
    "macosx_13_0_x86_64": System("x86_64-apple-macosx13.0", "x86_64-macos.13.0", ".dylib", (2, 3)),
    "macosx_13_0_arm64": System("arm64-apple-macosx13.0", "aarch64-macos.13.0", ".dylib", (1,)),
}

#: What LLVM calls the levels, and the level of x86-64 that Numba compiles for: ARM takes two numbers at a time, too.
_PROCESSORS: Final = {1: "generic", 2: "x86-64-v2", 3: "x86-64-v3"}
_COMPILED_AS: Final = {1: 2, 2: 2, 3: 3}

_ARM_LEVEL: Final = f"define i32 @{LEVEL}() {{\n  ret i32 1\n}}\n"

#: What a processor of x86-64 says of itself: Intel's manual, volume 2, CPUID; the levels are those of the psABI. Level
#: 3 asks the system, too, whether it keeps the wider registers (XGETBV).
_CPUID: Final = 'call {i32, i32, i32, i32} asm sideeffect "cpuid", "={ax},={bx},={cx},={dx},{ax},{cx}"'
_X86_LEVEL: Final = f"""
define i32 @{LEVEL}() {{
  %most = {_CPUID}(i32 0, i32 0)
  %leaves = extractvalue {{i32, i32, i32, i32}} %most, 0
  %one = {_CPUID}(i32 1, i32 0)
  %has = extractvalue {{i32, i32, i32, i32}} %one, 2
  %two = and i32 %has, {sum(1 << bit for bit in (0, 9, 13, 19, 20, 23))}
  %is2 = icmp eq i32 %two, {sum(1 << bit for bit in (0, 9, 13, 19, 20, 23))}
  br i1 %is2, label %second, label %none
none:
  ret i32 0
second:
  %three = and i32 %has, {sum(1 << bit for bit in (12, 22, 27, 28, 29))}
  %is3 = icmp eq i32 %three, {sum(1 << bit for bit in (12, 22, 27, 28, 29))}
  %more = icmp uge i32 %leaves, 7
  %may = and i1 %is3, %more
  br i1 %may, label %wider, label %plain
plain:
  ret i32 2
wider:
  %seven = {_CPUID}(i32 7, i32 0)
  %bits = extractvalue {{i32, i32, i32, i32}} %seven, 1
  %set = and i32 %bits, {sum(1 << bit for bit in (3, 5, 8))}
  %full = icmp eq i32 %set, {sum(1 << bit for bit in (3, 5, 8))}
  %last = {_CPUID}(i32 -2147483647, i32 0)
  %others = extractvalue {{i32, i32, i32, i32}} %last, 2
  %zeros = and i32 %others, {1 << 5}
  %counts = icmp ne i32 %zeros, 0
  %kept = call {{i32, i32}} asm sideeffect "xgetbv", "={{ax}},={{dx}},{{cx}}"(i32 0)
  %saved = extractvalue {{i32, i32}} %kept, 0
  %both = and i32 %saved, 6
  %system = icmp eq i32 %both, 6
  %a = and i1 %full, %counts
  %b = and i1 %a, %system
  %level = select i1 %b, i32 3, i32 2
  ret i32 %level
}}
"""


def emit_level(system: System) -> bytes:
    """Return object code of the function that says which level the processor has."""
    is_x86 = system.triple.startswith("x86")
    module = llvm.parse_assembly(_X86_LEVEL if is_x86 else _ARM_LEVEL)
    return _for_system(module, LEVEL, system, "x86-64" if is_x86 else "generic")


def emit_kernels(compiled_as: int, kernels: str, systems: Sequence[str]) -> Iterator[tuple[str, int, str, bytes]]:
    """Compile kernels as for a level, and yield system, level, function and object code for all that they serve.

    kernels  how their names begin
    """
    for kernel in all_kernels():
        if not kernel.name.startswith(kernels):
            continue
        module = kernel.module()
        name = function_name(kernel.source_digest)
        module.get_function(ENTRY).name = name
        for tag in systems:
            for level in SYSTEMS[tag].levels:
                if _COMPILED_AS[level] == compiled_as:
                    code = _for_system(module.clone(), name, SYSTEMS[tag], _PROCESSORS[level])
                    yield tag, level, name, code


def _for_system(module: object, name: str, system: System, processor: str) -> bytes:
    """Return object code of a function for a system."""
    if system.suffix == ".dll":
        module.get_function(name).storage_class = "dllexport"  # type: ignore[attr-defined]
    return emitted(module, Processor(system.triple, processor), set(SYSTEM))


def link(objects: Sequence[Path], system: System, output: Path) -> None:
    """Link object code into a library for a system.

    Raises ``subprocess.CalledProcessError``.
    """
    listed = output.with_suffix(".txt")  # more files than a command line has room for
    listed.write_text("\n".join(f'"{each.as_posix()}"' for each in objects), encoding="utf-8")
    command = [sys.executable, "-m", "ziglang", "cc", "-target", system.linked_for, "-shared", "-s", "-o", str(output)]
    subprocess.run([*command, f"@{listed}", "-lm"], check=True)
    listed.unlink()


def make_libraries(folder: Path, tags: Sequence[str] = tuple(SYSTEMS), kernels: str = "trunnion.") -> None:
    """Leave a folder of libraries for each system in a folder.

    tags     of the systems
    kernels  how the names of the kernels begin

    Raises ``OSError`` where such folders are there, and ``subprocess.CalledProcessError``.
    """
    for tag in tags:
        (folder / tag).mkdir(parents=True)
        (folder / tag / f"{BASE}.o").write_bytes(emit_level(SYSTEMS[tag]))
    _emit_all(folder, tags, kernels)
    for tag in tags:
        system, own = SYSTEMS[tag], folder / tag
        link([own / f"{BASE}.o"], system, own / f"{BASE}{system.suffix}")
        for level in system.levels:
            objects = sorted(own.glob(f"{level}-*.o"))
            link(objects, system, own / f"{library_name(level)}{system.suffix}")
            sys.stdout.write(f"{tag}: level {level}: {len(objects)} kernels\n")
        for file in own.iterdir():
            if file.suffix != system.suffix:
                file.unlink()


def _emit_all(folder: Path, tags: Sequence[str], kernels: str) -> None:
    """Compile for all levels, each in a process of its own: Numba is told of a processor before it is imported."""
    call = "from trunnion.jit.wheel_libraries import emit_named; emit_named()"  # __name__ may be __main__
    with tempfile.TemporaryDirectory() as kept:
        running = []
        for level in sorted({_COMPILED_AS[level] for tag in tags for level in SYSTEMS[tag].levels}):
            named = {"NUMBA_CPU_NAME": _PROCESSORS[level], "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": kept}
            path = os.pathsep.join(filter(None, (str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH"))))
            command = [sys.executable, "-c", call, str(level), str(folder), kernels, *tags]
            running.append((command, subprocess.Popen(command, env={**os.environ, **named, "PYTHONPATH": path})))
        for command, status in [(command, process.wait()) for command, process in running]:
            if status:
                raise subprocess.CalledProcessError(status, command)


def emit_named() -> None:
    """Write object code of the kernels, for a level and the systems that the arguments name."""
    level, folder, kernels, *tags = sys.argv[1:]
    for tag, each, name, code in emit_kernels(int(level), kernels, tags):
        Path(folder, tag, f"{each}-{name}.o").write_bytes(code)


if __name__ == "__main__":
    make_libraries(Path(sys.argv[1]), sys.argv[3:] or tuple(SYSTEMS), (sys.argv[2:] or ["trunnion."])[0])
