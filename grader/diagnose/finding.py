"""One thing that is wrong in a live system: a sentence, what it rests on, and what to do.

Made by the files in `looks/`, put in order here, shown by `course diagnose`.
"""

from __future__ import annotations

import enum
import importlib
import pkgutil
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from gz_course.grader.diagnose import looks

if TYPE_CHECKING:
    from gz_course.grader.diagnose.system import System


class Severity(enum.IntEnum):
    """How bad it is; the names are what is shown."""

    ERROR = 0
    """Something cannot work."""
    WARNING = 1
    """Something goes wrong, or is about to."""
    NOTE = 2
    """Works as it stands, and surprises people. Alone it is nothing wrong."""


@dataclass(frozen=True)
class Finding:
    """One finding. `kind` is the name of the file it comes from, filled in when it is collected.

    `topics` are the ROS topics whose silence it explains. A `symptom` is left out when all its topics are explained
    by a finding that is none.
    """

    severity: Severity
    sentence: str
    fix: str
    evidence: tuple[str, ...] = ()
    topics: frozenset[str] = frozenset()
    symptom: bool = False
    kind: str = ""

    def as_dict(self) -> dict[str, Any]:
        """What stands in the JSON report."""
        return {
            "kind": self.kind,
            "severity": self.severity.name.lower(),
            "sentence": self.sentence,
            "evidence": list(self.evidence),
            "fix": self.fix,
        }


def kinds() -> list[str]:
    """Names of the kinds of findings, sorted."""
    return sorted(module.name for module in pkgutil.iter_modules(looks.__path__))


def findings(system: System) -> list[Finding]:
    """Everything that is wrong, worst first."""
    modules = [importlib.import_module(f"{looks.__name__}.{kind}") for kind in kinds()]
    modules.sort(key=lambda module: (module.RANK, module.__name__))
    found = [
        replace(each, kind=module.__name__.rpartition(".")[2]) for module in modules for each in _of(module, system)
    ]
    found.sort(key=lambda finding: finding.severity)  # stable: within a severity the ranks hold
    explained = frozenset().union(*(each.topics for each in found if not each.symptom))
    return [each for each in found if not (each.symptom and each.topics and each.topics <= explained)]


def _of(module: Any, system: System) -> Iterator[Finding]:
    yield from module.look(system)
