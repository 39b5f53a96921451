"""The values that occur in an array are those that NumPy's ``unique`` finds, without its masked arrays."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from tests.support.locations import YL569
from trunnion.arrays import distinct


@given(
    arrays.arrays(
        st.sampled_from([np.float64, np.int64, np.int32, np.uint8, np.bool_]),
        arrays.array_shapes(min_dims=1, max_dims=2, min_side=0, max_side=9),
    )
)
def test_distinct_values_are_those_of_numpy(values: np.ndarray[tuple[int, ...], np.dtype[np.generic]]) -> None:
    found, expected = distinct(values), np.unique(values)

    assert found.dtype == expected.dtype
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("values", [[], [np.nan], [np.nan, 1.0, np.nan], [2.0, 1.0, 2.0, np.inf]])
def test_not_a_number_occurs_once(values: list[float]) -> None:
    np.testing.assert_array_equal(distinct(np.array(values)), np.unique(values))


def test_a_post_imports_no_masked_arrays() -> None:
    script = (
        "import sys\nfrom trunnion.cli import main\n"
        f"main(['post', {str(YL569 / '3_blade_finish.cls')!r}, '--machine', 'yl569', '--output', '-'])\n"
        "print('numpy.ma' in sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[-1] == "False"
