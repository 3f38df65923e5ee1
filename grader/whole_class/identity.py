"""What identifies a result: the student's submission, and all that decides what it earns. Equal keys, equal results."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import Any

from gz_course.grader.exercise.bundle import digest
from gz_course.grader.whole_class.versions import versions


def made_alike(exercise: str, files: dict[str, bytes], options: Sequence[str], reports: Sequence[str]) -> list[Any]:
    """Return what the results of a class have in common; `files` are those of the exercise."""
    return [exercise, digest(files), list(options), list(reports), versions()]


def key_of(made_of: Sequence[str], alike: Sequence[Any]) -> str:
    """Return the key of a result: of a submission and what the results of its class have in common."""
    return hashlib.sha256(json.dumps([*made_of, *alike], sort_keys=True).encode()).hexdigest()
