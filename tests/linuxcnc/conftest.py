"""What stands in for LinuxCNC's HAL, once in a process: a module's pins hang on the first that is there."""

import ctypes

import pytest

from tests.support.linuxcnc.kinematics import hal


@pytest.fixture(scope="session")
def stub(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """The functions that modules ask for pins and memory."""
    return hal(tmp_path_factory.mktemp("hal"))
