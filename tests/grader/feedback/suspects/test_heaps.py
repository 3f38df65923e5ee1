"""Searches with a heap out of which another cell than the nearest comes first."""

import ast

import pytest

from gz_course.grader.feedback.slips.geometry import searches
from gz_course.grader.feedback.suspects.planning import searches as goals_of_searches

SEARCH = """
def search(start):
    heap, cost = [(0.0, start)], {{start: 0.0}}
    while heap:
        g, cell = heapq.heappop(heap)
        for beside in around(cell):
            new = g + 1.0
            if new {} cost.get(beside, 1e9):
                cost[beside] = new
                heapq.heappush(heap, {})
"""


@pytest.mark.parametrize(
    ("pushed", "words"),
    [
        ("(new, beside)", ""),
        ("(new + guess(beside), -new, beside)", ""),
        ("(-new, beside)", "the farthest cells first"),
        ("(beside, new)", "begins with the cell beside"),
        ("((beside[0], beside[1]), new)", "begins with the cell"),
    ],
)
def test_what_stands_first_in_a_heap(pushed, words):
    said = [each for _, _, each in goals_of_searches.other_first(ast.parse(SEARCH.format("<", pushed)))]
    assert words in said[0] if words else said == []


def test_a_longer_way_is_taken_for_a_better_one():
    ((line, said),) = searches.relaxed_upwards(ast.parse(SEARCH.format(">", "(new, beside)")))
    assert line == 8 and "longer than the one that is known" in said
    assert not list(searches.relaxed_upwards(ast.parse(SEARCH.format("<", "(new, beside)"))))
