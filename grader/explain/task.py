"""What the task of an exercise speaks of: the words, numbers, topics and types that a right program may hold."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

from gz_course.grader.edits import Vocabulary
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.grading import README

NUMBER = re.compile(r"(?<![\w./])-?\d+(?:\.\d+)?(?:e-?\d+)?")
BAND = re.compile(r"between (-?[\d.]+\d) and (-?[\d.]+\d)|(?<![\w.])(-?\d[\d.]*) to (-?\d[\d.]*\d)")
TOPIC = re.compile(r"(?<![\w~])/\w[\w/]*(?![\w/])")
TYPE = re.compile(r"\b\w+/(?:msg|srv|action)/\w+|\bgz\.msgs\.\w+")
QUOTED = re.compile(r"`([^`\n]{2,60})`|\"([^\"\n]{2,60})\"|'([^'\n]{2,60})'")
WORD = re.compile(r"[a-z]{2,}|\b[xyz]\b")
MOST_RATIOS, MOST_NUMBERS = 6, 20
# Words of every report.
COMMON = {"the", "and", "for", "was", "is", "of", "to", "at", "in", "on", "it", "than", "between", "from", "least"}


def vocabulary(exercise: Exercise, failed: Sequence[dict[str, Any]]) -> Vocabulary:
    """Return what may stand in a right program, the likeliest first; `failed` are checks of a report in JSON."""
    wanted, measured = list[float](), list[float]()
    for check in failed:
        wanted += _wanted(str(check["expected"]))
        measured += _numbers(str(check["measured"]))
    task = (exercise.grading.parent / README).read_text(encoding="utf-8")
    graph = exercise.bridge.read_text(encoding="utf-8") if exercise.bridge is not None else ""
    graph += " ".join((*exercise.observe, *exercise.observe.values()))
    topics = dict.fromkeys([*TOPIC.findall(graph), *TOPIC.findall(TYPE.sub("", task))])
    return Vocabulary(
        numbers=tuple(dict.fromkeys([*wanted, *_numbers(task)]))[:MOST_NUMBERS],
        ratios=tuple(_ratios(wanted, measured))[:MOST_RATIOS],
        topics=tuple(topics),
        types=tuple(dict.fromkeys(TYPE.findall(f"{graph} {task}"))),
        texts=tuple(dict.fromkeys("".join(each) for each in QUOTED.findall(task))),
    )


def words_of(exercise: Exercise, failed: Sequence[dict[str, Any]]) -> set[str]:
    """Return the words in which the failed checks are defined and reported."""
    specs = {each.id: each for each in exercise.checks}
    said = " ".join(
        f"{each['id']} {each['title']} {each['measured']} {each['expected']} {specs[each['id']].parameters}"
        for each in failed
    )
    return words_in(said) - COMMON


def words_in(text: str) -> set[str]:
    """Return the words of a text; names are taken apart."""
    return set(WORD.findall(re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).replace("_", " ").lower()))


def _numbers(text: str) -> list[float]:
    found = (float(each) for each in NUMBER.findall(text))
    return [int(each) if each == int(each) else each for each in found if abs(each) < 1e9]


def _wanted(expected: str) -> Iterator[float]:
    """Yield the numbers that a check asks for; of a band first its middle."""
    for match in BAND.finditer(expected):
        low, high = (float(each) for each in match.groups() if each is not None)
        yield float(f"{(low + high) / 2:.4g}")
    yield from _numbers(expected)


def _ratios(wanted: Sequence[float], measured: Sequence[float]) -> Iterator[float]:
    seen = set[float]()
    for seen_value in measured:
        for each in wanted:
            if seen_value and each and (ratio := float(f"{each / seen_value:.4g}")) not in (1.0, *seen):
                seen.add(ratio)
                yield ratio
