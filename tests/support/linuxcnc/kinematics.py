"""LinuxCNC's own kinematics, called from its own compiled modules.

A module needs a HAL for its pins; a few functions, compiled when the test runs, replace it.
"""

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats

MODULES = Path("/usr/lib/linuxcnc/modules")

needs_modules = pytest.mark.skipif(
    not (MODULES / "xyzac-trt-kins.so").is_file() and not os.environ.get("CI"),
    reason="LinuxCNC is not installed (Debian package linuxcnc-uspace)",
)

needs_compiler = pytest.mark.skipif(
    shutil.which("gcc") is None and not os.environ.get("CI"), reason="there is no C compiler (Debian package gcc)"
)

_HAL = r"""
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Every pin is eight bytes of its own, found again by its name. */
struct pin { char name[96]; double *place; struct pin *next; };
static struct pin *pins;

static int attach(const char *name, void **where)
{
    struct pin *pin = calloc(1, sizeof *pin);
    pin->place = calloc(1, sizeof *pin->place);
    snprintf(pin->name, sizeof pin->name, "%s", name);
    pin->next = pins;
    pins = pin;
    *where = pin->place;
    return 0;
}

int judge_set(const char *name, double value)
{
    for (struct pin *pin = pins; pin; pin = pin->next)
        if (!strcmp(pin->name, name)) { *pin->place = value; return 1; }
    return 0;
}

int hal_init(const char *name) { return 1; }
int hal_ready(int id) { return 0; }
int hal_exit(int id) { return 0; }
void *hal_malloc(long size) { return calloc(1, size); }
int hal_pin_bit_new(const char *name, int dir, void **where, int id) { return attach(name, where); }
int hal_pin_s32_new(const char *name, int dir, void **where, int id) { return attach(name, where); }
int hal_pin_float_newf(int dir, void **where, int id, const char *form, ...)
{
    char name[96];
    va_list rest;
    va_start(rest, form);
    vsnprintf(name, sizeof name, form, rest);
    va_end(rest);
    return attach(name, where);
}
void rtapi_print(const char *form, ...) {}
void rtapi_print_msg(int level, const char *form, ...) {}
"""


class _Pose(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in "xyzabcuvw"]


def hal(folder: Path) -> ctypes.CDLL:
    """The functions that replace HAL. They must be loaded before a module."""
    source, library = folder / "hal.c", folder / "libjudgehal.so"
    source.write_text(_HAL)
    subprocess.run(["gcc", "-O2", "-shared", "-fPIC", "-o", str(library), str(source)], check=True)
    return ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)


class Kinematics:
    """One module; ``pins`` are its numbers, by pin name without that of the module."""

    def __init__(self, hal: ctypes.CDLL, module: str, pins: dict[str, float]) -> None:
        self._module = ctypes.CDLL(str(MODULES / f"{module}.so"), mode=os.RTLD_NOW | os.RTLD_LOCAL)
        assert self._module.rtapi_app_main() == 0
        self._module.kinematicsType()
        self._hal, self._name = hal, module
        for name, value in pins.items():
            self.set(name, value)

    def set(self, pin: str, value: float) -> None:
        assert self._hal.judge_set(f"{self._name}.{pin}".encode(), ctypes.c_double(value)), pin

    def joints(self, poses: Floats, count: int) -> Floats:
        """Joints of poses, (n, 9) X Y Z A B C U V W as the module takes them."""
        found = np.zeros((len(poses), 16))
        flag, other = ctypes.c_ulong(0), ctypes.c_ulong(0)
        for row, values in enumerate(poses.tolist()):
            pose = _Pose(*values)
            joints = (ctypes.c_double * 16)()
            done = self._module.kinematicsInverse(ctypes.byref(pose), joints, ctypes.byref(flag), ctypes.byref(other))
            assert done == 0
            found[row] = list(joints)
        return found[:, :count]
