"""`python`: the author's function is called, and every mistake of its is told with its line."""

import pytest

from gz_course.grader.errors import ManifestError

GOOD = """
import math
from gz_course.grader.score.check import Finding

def circles(recording, parameters):
    yaw = recording.signal("truth/robot/yaw").values
    turned = abs(yaw[-1]) / (2 * math.pi) if len(yaw) else 0.0
    wanted = parameters["turns"]
    return Finding(turned >= wanted, expected=f"{wanted} turns", measured=f"{turned:.1f} turns")

def wrong(recording, parameters):
    return True

def breaks(recording, parameters):
    return parameters["trns"]
"""


@pytest.fixture
def checked(tmp_path, record, found):
    def call(function="checks.py:circles", text=GOOD, yaw=13.0, **parameters):
        (tmp_path / "checks.py").write_text(text)
        recording = record({"truth/robot/yaw": [(0, 0.0), (8, yaw)]})
        return found("python", recording, tmp_path, function=function, **({"turns": 2} | parameters))

    return call


def test_the_function_decides(checked, tmp_path):
    assert (checked().passed, checked().measured) == (True, "2.1 turns")
    assert not checked(yaw=12.0).passed
    assert checked(turns=1, yaw=7.0).passed
    assert list(tmp_path.rglob("*.pyc")) == []


@pytest.mark.parametrize(
    ("function", "told"),
    [
        ("checks.py", r"FILE.py:FUNCTION"),
        ("../checks.py:circles", r"own folder"),
        ("cheks.py:circles", r"cheks\.py, which does not exist"),
        ("checks.py:circle", r"no function 'circle'; did you mean 'circles'"),
        ("checks.py:wrong", r"wrong\(\) must return a Finding, not True"),
        ("checks.py:breaks", r"checks\.py, line 15: KeyError: 'trns'"),
    ],
)
def test_a_mistake_in_naming_or_in_the_function(checked, function, told):
    with pytest.raises(ManifestError, match=told):
        checked(function)


def test_a_file_that_is_not_python(checked):
    with pytest.raises(ManifestError, match=r"checks\.py, line 1: SyntaxError"):
        checked(text="def")
