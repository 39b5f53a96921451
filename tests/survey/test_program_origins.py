"""The rule by which programs of CAM posts are told from others is that of their content."""

import pytest

from tests.support.program_origins import OF_CAM, Origin, origin

_FINE = "\n".join(f"G1 X{x}.123 Y{x}.456" for x in range(30))
_ROUND = "\n".join(f"G1 X{x}. Y{x}.5" for x in range(30))


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("(T1 D=3 CR=0 - ZMIN=-10 - flat end mill)\nG0 X1\nG1 X2 F9\nM30\n", Origin.NAMED),
        ("N10 ; Start of Path\nN20 G0 X1\nN30 G1 X2\nM30\n", Origin.NAMED),
        ("; made by hand\nG0 X1\nG1 X2\nM30\n", Origin.HAND),
        (f"S100 M3\n{_FINE}\nM30\n", Origin.FORM),
        (f"0 BEGIN PGM A MM\n1 TOOL CALL 2 Z S900\n{_FINE}\n99 END PGM A MM\n", Origin.FORM),
        (f"S100 M3\n{_ROUND}\nM30\n", Origin.HAND),
        (f"#1 = 5\nS100 M3\n{_FINE}\nM30\n", Origin.VARIABLES),
        (f"{_FINE}\n", Origin.PART),
        (f"PROC PART\n{_FINE}\nM17\n", Origin.PART),
        ("Dear reader,\nthe programs are in the other folder.\n", Origin.TEXT),
    ],
)
def test_the_first_that_holds_is_the_origin(text: str, found: Origin) -> None:
    assert origin(text) is found
    assert (found in OF_CAM) == (found in (Origin.NAMED, Origin.FORM))
