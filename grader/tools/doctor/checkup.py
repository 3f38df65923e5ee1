"""Asks every question of `checks/` at the same time and collects the answers.

`course doctor` prints them.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from types import ModuleType
from typing import Any

from gz_course.grader.registry import modules
from gz_course.grader.tools.doctor import checks
from gz_course.grader.tools.doctor.probe import ProbeError, Probes, TooSlow
from gz_course.grader.tools.doctor.verdict import Verdict, failed, warning

AT_ONCE = 4  # questions at the same time; most of them wait for a process


@dataclass(frozen=True)
class Finding:
    """The answer to one question: `check` is the name of its file, `title` its subject."""

    check: str
    title: str
    verdict: Verdict

    def as_dict(self) -> dict[str, Any]:
        """Return check, title, status (ok, warning, failed), seen and fix."""
        return {"check": self.check, "title": self.title, **asdict(self.verdict)}


def examine(deadline: float, asked: Sequence[ModuleType] | None = None) -> list[Finding]:
    """Ask every question, or those in `asked`, until `deadline` [s]; nothing is left running."""
    asked = list(modules(checks).values()) if asked is None else asked
    with ThreadPoolExecutor(AT_ONCE) as pool, Probes(deadline) as probes:
        answers = [pool.submit(_answer, module, probes) for module in asked]
        return [answer.result() for answer in answers]


def _answer(module: ModuleType, probes: Probes) -> Finding:
    try:
        verdict: Verdict = module.examine(probes)
    except TooSlow as slow:
        verdict = warning(f"not known: {slow}", "nothing has failed; try again with `course doctor --deadline 60`")
    except ProbeError as error:
        verdict = failed(str(error), "mend what it names; `course doctor` tries the same again")
    except Exception as error:  # a question that fails must not prevent the others
        told = f"{type(error).__name__}: {error}"
        verdict = failed(f"this check itself broke: {told}", "tell the course's maintainers, with this line")
    return Finding(module.__name__.rpartition(".")[2], module.TITLE, verdict)
