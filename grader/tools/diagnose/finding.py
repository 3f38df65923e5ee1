"""An error in a live system: a sentence, its evidence, and what to do.

The files in `looks/` make findings, this file sorts them, `course diagnose` prints them.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from gz_course.grader.registry import in_order, modules
from gz_course.grader.tools.diagnose import looks

if TYPE_CHECKING:
    from gz_course.grader.tools.diagnose.system import System


class Severity(enum.IntEnum):
    """The severity of a finding; the names are printed."""

    ERROR = 0
    """Something cannot work."""
    WARNING = 1
    """An error that happens now or will happen."""
    NOTE = 2
    """Behaviour that is correct but surprising; not an error."""


@dataclass(frozen=True)
class Finding:
    """One finding. `kind` is the name of the file it comes from, filled in when it is collected.

    `topics` are the ROS topics whose silence it explains. A `symptom` is left out when findings that are not symptoms
    explain all its topics.
    """

    severity: Severity
    sentence: str
    fix: str
    evidence: tuple[str, ...] = ()
    topics: frozenset[str] = frozenset()
    symptom: bool = False
    kind: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the finding as it appears in the JSON report."""
        return {
            "kind": self.kind,
            "severity": self.severity.name.lower(),
            "sentence": self.sentence,
            "evidence": list(self.evidence),
            "fix": self.fix,
        }


def findings(system: System) -> list[Finding]:
    """Return all findings, worst first; within a severity in the order the looks ask for."""
    found_by = modules(looks)
    order = in_order({name: getattr(module, "BEFORE", ()) for name, module in found_by.items()})
    found = [replace(each, kind=name) for name in order for each in found_by[name].look(system)]
    found.sort(key=lambda finding: finding.severity)
    explained = frozenset().union(*(each.topics for each in found if not each.symptom))
    return [each for each in found if not (each.symptom and each.topics and each.topics <= explained)]
