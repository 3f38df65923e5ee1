"""A node that has ended by itself, one that ran on, and one that died."""

from types import SimpleNamespace

import pytest

from gz_course.grader.feedback.recorded.places import ended_by_itself

PLACE = {"file": "node.py", "line": 7, "said": "`sys.exit()` in drive() ends the program"}


@pytest.mark.parametrize(
    ("facts", "before", "words"),
    [
        ({"exit_at": 9.0, "exit_code": 0, "own_ends": [PLACE]}, None, "at 9.0 s (exit code 0): line 7: `sys.exit()`"),
        ({"exit_at": 9.0, "exit_code": 0}, None, "nothing of it runs after that"),
        ({"exit_at": 9.0, "exit_code": 0}, 8.0, ""),
        ({"exit_at": 9.0, "exit_code": 1, "own_ends": [PLACE]}, None, ""),
        ({"own_ends": [PLACE]}, None, ""),
    ],
)
def test_a_node_that_ends_by_itself(facts, before, words):
    said = ended_by_itself(SimpleNamespace(facts=lambda: facts), before)
    assert bool(said) == bool(words) and words in said
