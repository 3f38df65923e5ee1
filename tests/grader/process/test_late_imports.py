"""Names that a package passes on are imported when they are used, and are what they would be otherwise."""

import json
import subprocess
import sys

import pytest

PACKAGE = {
    "big/__init__.py": """
from __future__ import annotations
from typing import TYPE_CHECKING
from big.small import Used, Small as Small
from . import parts as parts, small as little
from .parts import Part as Part, make as build
from .star import *
if TYPE_CHECKING:
    from .parts import Part as Typed
USES = Used
def __getattr__(name):
    if name == "old":
        return "deprecated"
    raise AttributeError(name)
""",
    "big/parts/__init__.py": "from ._part import Part as Part, make as make\n",
    "big/parts/_part.py": "from big import Small\nclass Part(Small): pass\ndef make(): return Part()\n",
    "big/small.py": "class Small: pass\nclass Used: pass\n",
    "big/star.py": "everything = 1\n",
    "big/alone.py": "value = 2\n",
}
SEEN = """
import json, sys
{prepare}
import big
before = sorted(name for name in sys.modules if name.startswith("big"))
made = big.build()
same = [type(made) is big.Part, issubclass(big.Part, big.Small), big.little.Small is big.Small, big.USES is big.Used]
from big import parts, everything, old
import big.alone
try:
    big.missing
except AttributeError as error:
    lack = "missing" in str(error)
print(json.dumps([before, same, parts.__name__, everything, old, big.alone.value, lack, big.star.__name__]))
"""
PREPARE = 'from gz_course.grader.process.late_imports import late_imports; late_imports("big"); late_imports("big")'


@pytest.mark.parametrize("prepare", ["", PREPARE])
def test_a_package_gives_the_same(tmp_path, prepare):
    for name, text in PACKAGE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    before, *rest = json.loads(output(SEEN.format(prepare=prepare), tmp_path))
    assert rest == [[True] * 4, "big.parts", 1, "deprecated", 2, True, "big.star"]
    late = ["big", "big.small", "big.star"]  # what the file itself uses, and a star, which names nothing
    assert before == (late if prepare else sorted({*late, "big.parts", "big.parts._part"}))


# Of each name in Rerun's packages: the module and the name of its class or function.
NAMES = """
import json
{prepare}
import rerun, rerun.blueprint, rerun.chunk
if {late}:
    names = json.load(open("names.json"))
else:
    names = {{package: [n for n in dir(eval(package)) if not n.startswith("_")] for package in
              ("rerun", "rerun.blueprint", "rerun.chunk", "rerun.archetypes", "rerun.components", "rerun.encodings")}}
    json.dump(names, open("names.json", "w"))
what = lambda value: [getattr(value, "__module__", ""), getattr(value, "__qualname__", getattr(value, "__name__", ""))]
print(json.dumps({{p: {{n: what(getattr(eval(p), n)) for n in found}} for p, found in names.items()}}))
"""


def test_rerun_is_the_same(tmp_path):
    whole = json.loads(output(NAMES.format(prepare="", late=False), tmp_path))
    late = json.loads(output(NAMES.format(prepare=PREPARE.replace("big", "rerun"), late=True), tmp_path))
    assert late == whole and len(whole["rerun"]) > 100


def output(program, folder):
    """Return what a Python that runs a program in a folder prints."""
    return subprocess.run(
        [sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, check=True, timeout=60
    ).stdout
