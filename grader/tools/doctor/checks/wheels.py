"""Are the packages the course needs installed, in the versions it is tested with (`constraints.txt`)?"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from importlib import metadata
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning

TITLE = "installed packages"
COURSE = "gz-ros2-course"
CONSTRAINTS = Path(__file__).parents[4] / "constraints.txt"
SHOWN = 4  # packages named in one sentence
RUNTIME = re.compile(r"extra == ['\"]runtime['\"]")  # what `dependencies` in pyproject.toml asks for
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


def examine(probes: Probes) -> Verdict:
    """Compare what is installed with what the course requires and what it is tested with."""
    install = "install again with `pip install -c constraints.txt -e .` in the course's folder"
    try:
        asked = metadata.requires(COURSE) or []
    except metadata.PackageNotFoundError:
        return failed(f"{COURSE} is not installed in this Python", install)
    versions = installed()
    if missing := [name for name in required(asked) if name not in versions]:
        return failed(f"not installed: {_few(missing)}", install)
    try:
        pins = pinned(CONSTRAINTS.read_text(encoding="utf-8"))
    except OSError:
        return warning(
            f"{len(versions)} packages; versions not compared: there is no {CONSTRAINTS.name} with this installation",
            "install the course from its folder to have them compared",
        )
    other = [f"{n} {versions[n]} (tested: {v})" for n, v in sorted(pins.items()) if versions.get(n, v) != v]
    if other:
        return warning(f"other versions than tested: {_few(other)}", install)
    return fine(f"{sum(name in versions for name in pins)} packages, all in the versions the course is tested with")


def normal(name: str) -> str:
    """Return a package's name as pip compares it: lower case, one dash for any run of `-`, `_` and `.`.

    Source: PEP 503, "Normalized Names".
    """
    return re.sub(r"[-_.]+", "-", name).lower()


def required(requirements: Iterable[str]) -> list[str]:
    """Return the names in the course's list of requirements, without those of extras other than its `runtime`."""
    plain = [text for text in requirements if "extra ==" not in text or RUNTIME.search(text)]
    return [normal(found.group()) for text in plain if (found := _NAME.match(text))]


def pinned(text: str) -> dict[str, str]:
    """Return name and version of each line `name==version` of a constraints file."""
    lines = [line.partition("#")[0].partition(";")[0].strip() for line in text.splitlines()]
    pairs = [line.split("==", 1) for line in lines if "==" in line]
    return {normal(name.strip()): version.strip() for name, version in pairs}


def installed() -> Mapping[str, str]:
    """Return name and version of everything this Python can import; of several copies the first, as in an import."""
    found: dict[str, str] = {}
    for each in metadata.distributions():
        name = each.metadata["Name"]
        if name:
            found.setdefault(normal(name), each.version)
    return found


def _few(names: list[str]) -> str:
    rest = len(names) - SHOWN
    return ", ".join(names[:SHOWN]) + (f" and {rest} more" if rest > 0 else "")
