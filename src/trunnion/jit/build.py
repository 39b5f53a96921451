"""Libraries made of what Numba compiles: the only file that needs more of Numba than its public interface.

Numba compiles an entry for a kernel, written here, that makes arrays and tuples of plain numbers and addresses and
calls the kernel (``numba.cfunc``, ``numba.carray``, ``inspect_llvm``: all public). What is known beyond that:

    how Numba's own functions are called: address of the result, address of what describes an exception, arguments; what
    they give (``_OK``, ``_NONE``), and what describes an exception (a pickle's address and length)
    how its runtime keeps arrays and lists that kernels make (``trunnion.jit.runtime``), which is written anew

It is checked as far as it can be (``_native``, ``_unresolved``), and belongs to the versions of Numba that were tried
(``TRIED``). With another one kernels are compiled by Numba's own way (``trunnion.jit.judge``), and nothing is kept that
could be called wrongly.
"""

import re
import subprocess
import tempfile
from collections.abc import Callable, Sequence, Set
from pathlib import Path
from shutil import which
from sys import platform
from typing import Any, Final, NamedTuple

import numba
from llvmlite import binding as llvm

from trunnion.jit import library
from trunnion.jit.arguments import Array, Kind, Parts, leaves
from trunnion.jit.judge import element_type, register
from trunnion.jit.runtime import RUNTIME

#: Versions of Numba whose output was compared with what Numba itself does.
TRIED: Final = ("0.68",)

#: What Numba's functions give: done, and done with ``None``.
_OK, _NONE = 0, -2

_LLVM_TYPES: Final = {int: "i64", float: "double", bool: "i8"}


class NotBuiltError(Exception):
    """A library cannot be made here."""


class Processor(NamedTuple):
    """What object code is made for, by LLVM's names."""

    triple: str
    name: str
    features: str = ""

    def machine(self) -> Any:
        """Return what emits object code for it."""
        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
        llvm.initialize_native_asmparser()  # for the question what a processor can do
        target = llvm.Target.from_triple(self.triple)
        return target.create_target_machine(cpu=self.name, features=self.features, opt=3, reloc="pic")


def this_processor() -> Processor:
    """Return the one of this computer."""
    return Processor(
        llvm.get_default_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten(),
    )  # fmt: skip


def object_code(
    function: Callable[..., Any],
    kinds: Sequence[Kind],
    results: tuple[tuple[type, ...], bool],
    options: dict[str, Any],
) -> bytes:
    """Compile a kernel into object code for this processor with one function, ``library.ENTRY``.

    options  of Numba: ``error_model``

    Raises ``NotBuiltError`` where that is not known to be right.
    """
    module = kernel_module(function, kinds, results, options)
    return emitted(module, this_processor(), library.find_system(llvm))


def kernel_module(
    function: Callable[..., Any],
    kinds: Sequence[Kind],
    results: tuple[tuple[type, ...], bool],
    options: dict[str, Any],
) -> Any:
    """Compile a kernel into a module of LLVM with one function that is called, ``library.ENTRY``.

    options  of Numba: ``error_model``

    Raises ``NotBuiltError`` where that is not known to be right.
    """
    if not numba.__version__.startswith(tuple(f"{version}." for version in TRIED)):
        raise NotBuiltError(f"not tried with Numba {numba.__version__}")
    if not library.is_as_expected():
        raise NotBuiltError("arrays are laid out otherwise here")
    compiled = _compiled(function, kinds, results, options)
    text = _without_instructions(compiled.inspect_llvm())
    native = _native(text, compiled.native_name, kinds)
    module = llvm.parse_assembly(text)
    module.link_in(llvm.parse_assembly(_entry(native, kinds, results)))
    module.link_in(llvm.parse_assembly(RUNTIME))
    for value in (*module.functions, *module.global_variables):
        if value.name != library.ENTRY and not value.is_declaration:
            value.linkage = llvm.Linkage.internal
    return module


def _without_instructions(text: str) -> str:
    """Replace what LLVM has put into Numba's output for x86: a count is taken from, and asked whether it is 0 (4)."""
    name = "@llvm.x86.atomic.sub.cc.i64"
    text = re.sub(rf"{re.escape(name)}(\(ptr [^\n()]*, i64 \d+), i32 4\)", r"@last_taken\1)", text)
    return re.sub(
        rf"^declare [^\n]*{re.escape(name)}[^\n]*$", "declare i8 @last_taken(ptr, i64)", text, flags=re.MULTILINE
    )


#: Numba's type of an address of things of a type.
_pointer: Callable[[Any], Any] = numba.types.CPointer


def _compiled(
    function: Callable[..., Any],
    kinds: Sequence[Kind],
    results: tuple[tuple[type, ...], bool],
    options: dict[str, Any],
) -> Any:
    """Have Numba compile the function that makes the kernel's arguments and calls it."""
    public: Any = numba
    names: dict[str, Any] = {"kernel": function, "carray": public.carray}
    types: list[Any] = []
    given = [_expression(kind, types, names) for kind in kinds]
    for number in (numba.int64, numba.float64):
        types.append(_pointer(number))
    found = "".join(
        f"    {'floats' if kind is float else 'ints'}[{k}] = {'int' if kind is bool else ''}"
        f"(found{f'[{k}]' if results[1] else ''})\n"
        for k, kind in enumerate(results[0])
    )
    arguments = "".join(f"a{k}, " for k in range(len(types) - 2))
    source = f"def entry({arguments}ints, floats):\n    found = kernel({', '.join(given)})\n{found}    return 0\n"
    exec(source, names)
    register(function)
    return numba.cfunc(numba.int64(*types), **options)(names["entry"])


def _expression(kind: Kind, types: list[Any], names: dict[str, Any]) -> str:
    """Return how the entry makes an argument, and append the types of what it makes it from."""
    first = len(types)
    if isinstance(kind, Array):
        types.append(_pointer(element_type(kind)))
        types.extend([numba.int64] * kind.dimensions)
        shape = "".join(f"a{first + 1 + k}, " for k in range(kind.dimensions))
        return f"carray(a{first}, ({shape}))"
    if isinstance(kind, Parts):
        parts = "".join(f"{_expression(part, types, names)}, " for part in kind.kinds)
        if kind.made is tuple:
            return f"({parts})"
        name = f"Tuple{len(names)}"
        names[name] = kind.made
        return f"{name}({parts})"
    types.append({int: numba.int64, float: numba.float64, bool: numba.boolean}[kind])
    return f"a{first}"


def _native(text: str, wrapper: str, kinds: Sequence[Kind]) -> str:
    """Return the name of Numba's own function for the entry: that which the one with C's interface calls.

    Raises ``NotBuiltError`` if it takes anything else than is passed.
    """
    name = wrapper.removeprefix("cfunc.")
    found = re.search(rf'^define [^\n@]*i32 @"?{re.escape(name)}"?\(([^\n]*)\)[^()\n]*\{{$', text, re.MULTILINE)
    if wrapper == name or found is None:
        raise NotBuiltError("Numba's own function is not found")
    plain = re.sub(r"\([^()]*\)", "", found[1])
    taken = [argument.split()[0] for argument in plain.split(",")]
    passed = ["ptr", "ptr"]
    for kind in leaves(kinds):
        passed += ["ptr", *["i64"] * kind.dimensions] if isinstance(kind, Array) else [_LLVM_TYPES[kind]]
    if taken != [*passed, "ptr", "ptr"]:
        raise NotBuiltError(f"Numba's own function takes {taken}")
    return name


def _entry(native: str, kinds: Sequence[Kind], results: tuple[tuple[type, ...], bool]) -> str:
    """Write the function that is called: it looks at the arrays, and calls Numba's own function."""
    flat = list(leaves(kinds))
    arrays = [k for k, kind in enumerate(flat) if isinstance(kind, Array)]
    lines = [f"define i32 @{library.ENTRY}(ptr %block) {{"]
    passed = ["ptr %result", "ptr %described"]
    for k, kind in enumerate(flat):
        lines.append(f"  %at{k} = getelementptr i64, ptr %block, i64 {k}")
        if not isinstance(kind, Array):
            lines.append(f"  %v{k} = load {_LLVM_TYPES[kind]}, ptr %at{k}")
            passed.append(f"{_LLVM_TYPES[kind]} %v{k}")
            continue
        flags = library.CONTIGUOUS | library.ALIGNED | (library.WRITEABLE if kind.is_written else 0)
        lines += [
            f"  %o{k} = load ptr, ptr %at{k}",
            f"  %flags_at{k} = getelementptr i8, ptr %o{k}, i64 {library.FLAGS}",
            f"  %flags{k} = load i32, ptr %flags_at{k}",
            f"  %set{k} = and i32 %flags{k}, {flags}",
            f"  %good{k} = icmp eq i32 %set{k}, {flags}",
            f"  %size_at{k} = getelementptr i8, ptr %o{k}, i64 {library.DIMENSIONS}",
            f"  %size{k} = load i32, ptr %size_at{k}",
            f"  %right{k} = icmp eq i32 %size{k}, {kind.dimensions}",
            f"  %type_at{k} = getelementptr i8, ptr %o{k}, i64 {library.TYPE}",
            f"  %type{k} = load ptr, ptr %type_at{k}",
            f"  %due_at{k} = getelementptr i64, ptr %block, i64 {len(flat) + arrays.index(k)}",
            f"  %due{k} = load ptr, ptr %due_at{k}",
            f"  %same{k} = icmp eq ptr %type{k}, %due{k}",
            f"  %both{k} = and i1 %good{k}, %right{k}",
            f"  %fit{k} = and i1 %both{k}, %same{k}",
            f"  br i1 %fit{k}, label %next{k}, label %unfit{k}",
            f"unfit{k}:",
            f"  ret i32 {library.UNFIT + k}",
            f"next{k}:",
            f"  %data_at{k} = getelementptr i8, ptr %o{k}, i64 {library.DATA}",
            f"  %v{k} = load ptr, ptr %data_at{k}",
            f"  %shape_at{k} = getelementptr i8, ptr %o{k}, i64 {library.SHAPE}",
            f"  %shape{k} = load ptr, ptr %shape_at{k}",
        ]
        passed.append(f"ptr %v{k}")
        for j in range(kind.dimensions):
            lines.append(f"  %n{k}_at{j} = getelementptr i64, ptr %shape{k}, i64 {j}")
            lines.append(f"  %n{k}_{j} = load i64, ptr %n{k}_at{j}")
            passed.append(f"i64 %n{k}_{j}")
    declared = ", ".join(each.split()[0] for each in [*passed, "ptr", "ptr"])
    room = len(flat) + len(arrays)
    lines += [
        f"  %room = getelementptr i64, ptr %block, i64 {room}",
        "  %result = alloca i64",
        "  %described = alloca ptr",
        "  store ptr null, ptr %described",
        f'  %status = call i32 @"{native}"({", ".join([*passed, "ptr %room", "ptr %room"])})',
        f"  switch i32 %status, label %raised [ i32 {_OK}, label %done i32 {_NONE}, label %done ]",
        "done:",
        "  ret i32 0",
        "raised:",
        f"  %length_at = getelementptr i64, ptr %block, i64 {room + 1}",
        "  store i64 0, ptr %room",
        "  %what = load ptr, ptr %described",
        "  %unsaid = icmp eq ptr %what, null",
        "  br i1 %unsaid, label %end, label %ask",
        "ask:",
        "  %dynamic_at = getelementptr i8, ptr %what, i64 32",
        "  %dynamic = load i32, ptr %dynamic_at",
        "  %fixed = icmp slt i32 %dynamic, 1",
        "  br i1 %fixed, label %say, label %end",
        "say:",
        "  %pickle = load ptr, ptr %what",
        "  store ptr %pickle, ptr %room",
        "  %after = getelementptr i8, ptr %what, i64 8",
        "  %short = load i32, ptr %after",
        "  %long = zext i32 %short to i64",
        "  store i64 %long, ptr %length_at",
        "  br label %end",
        "end:",
        f"  ret i32 {library.RAISED}",
        "}",
        f'declare i32 @"{native}"({declared})',
    ]
    return "\n".join(lines)


def emitted(module: Any, processor: Processor, system: Set[str]) -> bytes:
    """Keep what the entry of a kernel's module needs, and make object code of it.

    system  names of the functions that the system has

    Raises ``NotBuiltError`` where it needs others.
    """
    machine = processor.machine()
    module.triple, module.data_layout = processor.triple, str(machine.target_data)
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(3)))
    module.verify()
    unresolved = {
        value.name
        for value in (*module.functions, *module.global_variables)
        if value.is_declaration and (not value.name.startswith("llvm.") or value.name.startswith("llvm.x86."))
    } - system
    if unresolved:
        raise NotBuiltError(f"it needs {', '.join(sorted(unresolved))}")
    code: bytes = machine.emit_object(module)
    return code


def shared_library(code: bytes) -> bytes | None:
    """Link object code by the linker of the system; None where there is none, or where it cannot."""
    linker = which("cc") or which("clang") or which("gcc")
    if linker is None or platform == "win32":
        return None
    try:
        with tempfile.TemporaryDirectory() as folder:
            made, source = Path(folder, "kernel.so"), Path(folder, "kernel.o")
            source.write_bytes(code)
            done = subprocess.run(
                [linker, "-shared", "-o", str(made), str(source), "-lm"],
                stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=60,
            )  # fmt: skip
            return made.read_bytes() if done.returncode == 0 else None
    except (OSError, subprocess.TimeoutExpired):
        return None
