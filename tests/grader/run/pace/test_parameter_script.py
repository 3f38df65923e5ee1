"""A parameter that the grader sets during a run is set at its simulated time, whatever the node does then."""

from types import SimpleNamespace

import pytest

from gz_course.grader.exercise.trial import ScriptedParameter
from gz_course.grader.run.parameter_script import ParameterScript

SAYS_ITS_PARAMETER = """
node.declare_parameter("speed", 1.0)
said = node.create_publisher(String, "/said", 10)
node.create_timer(0.1, lambda: said.publish(String(data=f"{node.get_name()} {node.get_parameter('speed').value}")))
rclpy.spin(node)
"""
SLEEPS = """
import time
node.declare_parameter("speed", 1.0)
said = node.create_publisher(String, "/said", 10)

def speak():
    time.sleep(0.25)
    said.publish(String(data=str(node.get_parameter("speed").value)))

node.create_timer(0.5, speak)
rclpy.spin(node)
"""


@pytest.fixture
def script():
    """Function giving what sets the parameters at their ticks; afterwards it has the facts and what was recorded."""

    def make(*entries):
        recorded = SimpleNamespace(facts=[], values=[], lines=[])
        recorder = SimpleNamespace(
            name=lambda *_: None,
            scalar=lambda entity, value: recorded.values.append((entity, value)),
            text=lambda entity, line, level: recorded.lines.append((level, line)),
        )
        made = []

        def before_tick(tick, ros, pace):
            if not made:
                made.append(ParameterScript(ros, pace, entries))
                recorded.facts = made[0].facts
            for entry in entries:
                if entry.at == tick:
                    made[0].set(entry, recorder)

        recorded.before_tick = before_tick
        return recorded

    return make


def test_two_nodes_are_set_at_their_ticks_and_what_is_not_declared_is_refused(play, script):
    recorded = script(
        ScriptedParameter(3, "/first", "speed", 2.5),
        ScriptedParameter(3, "/second", "sped", 2.5),
        ScriptedParameter(4, "/second", "speed", "fast"),
        ScriptedParameter(5, "/second", "speed", 0.5),
    )
    played = play(ticks=6, before_tick=recorded.before_tick, first=SAYS_ITS_PARAMETER, second=SAYS_ITS_PARAMETER)
    first, second = ([said for said in played.heard if said.startswith(name)] for name in ("first", "second"))
    assert first == ["first 1.0"] * 2 + ["first 2.5"] * 4
    assert second == ["second 1.0"] * 4 + ["second 0.5"] * 2
    assert [fact["outcome"] for fact in recorded.facts] == ["set", "refused", "refused", "set"]
    assert "undeclared" in recorded.facts[1]["reason"] and "STRING" in recorded.facts[2]["reason"]
    assert recorded.values == [(f"parameters/{n}", v) for n, v in (("speed", 2.5), ("sped", 2.5), ("speed", 0.5))]
    assert recorded.lines[0] == ("INFO", "ros2 param set /first speed 2.5: set")
    assert played.pace.paced_ticks == 0


@pytest.mark.proof
def test_a_node_that_sleeps_is_set_when_it_wakes_and_a_node_that_is_missing_is_reported(play, script):
    recorded = script(ScriptedParameter(6, "/lonely", "speed", 2.5), ScriptedParameter(9, "/nobody", "speed", 2.5))
    played = play(ticks=14, holding=False, simulated=True, before_tick=recorded.before_tick, lonely=SLEEPS)
    assert [fact["outcome"] for fact in recorded.facts] == ["no answer", "no answer"]
    assert played.heard == ["1.0", "2.5"]
    assert played.pace.paced_ticks == 0
