"""Code for the official packages of Harmonic runs unchanged; installed ones are used instead."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]

SAME = """
import gz.msgs10.twist_pb2
from gz.msgs10.twist_pb2 import Twist
from gz.transport13 import AdvertiseMessageOptions, Node, NodeOptions, SubscribeOptions
import gz.msgs, gz.msgs.twist_pb2, gz.transport
assert Twist is gz.msgs.twist_pb2.Twist is gz.msgs.message_class("gz.msgs.Twist")
assert gz.msgs10.twist_pb2 is gz.msgs.twist_pb2
assert Node is gz.transport.Node and NodeOptions is gz.transport.NodeOptions
import gz.transport13, gz.msgs10
assert set(gz.transport13.__all__) == set(gz.transport.__all__)
try:
    import gz.msgs10.twost_pb2
except ModuleNotFoundError:
    print("fine")
"""
REAL = """
import gz.transport13, gz.msgs10.twist_pb2
print(gz.transport13.WHOSE, gz.msgs10.twist_pb2.WHOSE, gz.transport13.part())
"""


def run(code, *path):
    environment = {**os.environ, "PYTHONPATH": ""}
    program = f"import sys; sys.path += {list(map(str, path))!r}\n{code}"
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", program], capture_output=True, text=True, timeout=600, env=environment
    )


def test_the_names_of_harmonic_are_the_same_objects():
    done = run(SAME)
    assert (done.stdout, done.stderr) == ("fine\n", "")


@pytest.fixture
def installation(tmp_path):
    for name in ("transport13", "msgs10"):
        folder = tmp_path / "gz" / name
        folder.mkdir(parents=True)
        (folder / "__init__.py").write_text("WHOSE = 'theirs'\n")
    (tmp_path / "gz/transport13/__init__.py").write_text("WHOSE = 'theirs'\nfrom ._part import part\n")
    (tmp_path / "gz/transport13/_part.py").write_text("def part():\n    return 'part'\n")
    (tmp_path / "gz/msgs10/twist_pb2.py").write_text("WHOSE = 'theirs'\n")
    return tmp_path


def test_a_real_installation_wins_even_when_it_comes_last(installation):
    done = run(REAL, installation)
    assert (done.stdout, done.stderr) == ("theirs theirs part\n", "")


@pytest.fixture
def copies(tmp_path):
    """Return three more checkouts of ours on the import path, as in a clone within a clone."""
    folders = [tmp_path / f"copy{number}" for number in range(3)]
    for folder in folders:
        shutil.copytree(ROOT / "public", folder, ignore=shutil.ignore_patterns("__pycache__"))
    return folders


def test_other_copies_of_ours_are_no_installation(copies):
    done = run(SAME + "print(gz.msgs10.__file__, gz.transport13.__file__)", *copies)
    assert (done.stdout, done.stderr) == (
        f"fine\n{ROOT}/sim/gz/msgs/__init__.py {ROOT}/sim/gz/transport/__init__.py\n",
        "",
    )


def test_an_installation_behind_other_copies_of_ours_still_wins(copies, installation):
    done = run(REAL, copies[0], installation, *copies[1:])
    assert (done.stdout, done.stderr) == ("theirs theirs part\n", "")


def test_an_installation_that_cannot_be_imported_is_as_good_as_none(installation):
    (installation / "gz/transport13/__init__.py").write_text("import no_such_library\n")
    (installation / "gz/msgs10/__init__.py").write_text("import no_such_library\n")
    done = run(SAME.replace("import gz.msgs10.twost_pb2", "raise ModuleNotFoundError"), installation)
    assert done.stderr == ""
