"""Why a parameter was not set during a run, in one sentence with the command that shows the same."""

import pytest

from gz_course.grader.score.parameters_set import parameter_not_set

FACT = {"at": 5.0, "node": "/driver", "name": "speed", "value": 0.2, "reason": ""}


@pytest.mark.parametrize(
    ("outcome", "reason", "nodes", "said"),
    [
        ("refused", "Invalid access to undeclared parameter(s): []", ["/driver"], "declare_parameter('speed', 0.2)"),
        ("refused", "too fast\x1b[2J", ["/driver"], "was refused: too fast\N{REPLACEMENT CHARACTER}[2J."),
        ("refused", "", ["/driver"], "without a reason"),
        ("no answer", "", ["/pilot"], "yours is /pilot: the name is the argument of Node's __init__"),
        ("no answer", "", ["/driver"], "only while it spins"),
    ],
)
def test_the_first_parameter_that_was_not_set_is_named(outcome, reason, nodes, said):
    facts = {
        "nodes": nodes,
        "parameters_set": [FACT | {"outcome": "set"}, FACT | {"outcome": outcome, "reason": reason}],
    }
    sentence = parameter_not_set(None, facts)
    assert sentence.startswith("`ros2 param set /driver speed 0.2` at 5 s ") and said in sentence


def test_nothing_is_said_where_nothing_was_refused():
    assert parameter_not_set(None, {}) == parameter_not_set(None, {"parameters_set": [FACT | {"outcome": "set"}]}) == ""


def test_a_result_that_refuses_is_named_with_its_line():
    slip = {"file": "driver.py", "line": 7, "said": "SetParametersResult() refuses the new value"}
    facts = {"nodes": ["/driver"], "parameters_set": [FACT | {"outcome": "refused"}], "slips": [slip]}
    assert "without a reason: line 7: SetParametersResult() refuses" in parameter_not_set(None, facts)


def test_a_sleep_that_keeps_the_node_from_answering_is_named_with_its_line():
    slip = {
        "file": "driver.py",
        "line": 9,
        "said": "time.sleep(0.5) in the callback on_scan",
    }
    facts = {"nodes": ["/driver"], "parameters_set": [FACT | {"outcome": "no answer"}], "slips": [slip]}
    assert "callbacks waits: line 9: time.sleep(0.5) in the callback" in parameter_not_set(None, facts)
