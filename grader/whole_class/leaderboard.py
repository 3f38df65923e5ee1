"""The leaderboard of a class: for each number that ranks it, who has which place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.leaderboard import HIGHEST

MOST = 20  # places that are shown

Result = dict[str, Any]


@dataclass(frozen=True)
class Board:
    """The places of one number, the best first: place, student and number; equal numbers share a place."""

    name: str
    places: tuple[tuple[int, str, float], ...]


def boards(exercise: Exercise, results: Sequence[Result]) -> list[Board]:
    """Return a board for each number of the exercise that somebody has."""
    found = []
    for ranked in exercise.leaderboard:
        values = [
            (float(place["value"]), str(result["student"]))
            for result in results
            for place in result.get("leaderboard", ())
            if place["name"] == ranked.name
        ]
        values.sort(key=lambda each: (-each[0] if ranked.best == HIGHEST else each[0], each[1]))
        numbers = [value for value, _ in values]
        placed = tuple((numbers.index(value) + 1, student, value) for value, student in values[:MOST])
        if placed:
            found.append(Board(ranked.name, placed))
    return found
