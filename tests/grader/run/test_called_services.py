"""The script calls a service of an ordinary node: the answer is recorded, and why there is none is said."""

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.trial import ScriptedCall
from gz_course.grader.record.reading import Recording

NAME = "00_first_run"
TRIALS = """
[[trial]]
name = "called"

[[trial.script]]
at = 1.2
service = "/reset"
type = "std_srvs/srv/SetBool"
request = { data = true }

[trial.check.arrives]
gate = { signal = "calls/reset/success", reaches = 1, otherwise = "nobody was reset" }
"""
SERVER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import SetBool


class Hello(Node):
    def __init__(self):
        super().__init__("hello")
        self.publisher = self.create_publisher(String, "/hello", 10)
        self.timer = self.create_timer(1.0, self.say)
        self.create_service(SetBool, "/reset", self.on_reset)

    def say(self):
        self.publisher.publish(String(data="hello, robot"))
        self.timer.cancel()

    def on_reset(self, request, response):
        response.success, response.message = request.data, "as you like"
        return response


rclpy.init()
rclpy.spin(Hello())
"""


@pytest.fixture
def called(grade, tmp_path):
    """`called(text)`: the outcome of a node in a trial in which its service is called, and its recording."""

    def run(text):
        (tmp_path / "hello_node.py").write_text(text)
        (tmp_path / "trials.toml").write_text(TRIALS)
        outcome = grade(NAME, tmp_path / "hello_node.py", "--trials", tmp_path / "trials.toml")
        return outcome, Recording(outcome.recording)

    return run


def test_the_answer_is_recorded(called):
    outcome, recording = called(SERVER)
    assert "arrives" not in outcome.failed(), outcome.output
    assert recording.signal("calls/reset/answered").values.tolist() == [1.0]
    assert recording.signal("calls/reset/success").times.tolist() == [1_200_000_000]
    assert [line.text for line in recording.lines("calls/reset/message")] == ["as you like"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            '"/reset", self',
            '"/rest", self',
            ["`ros2 service call /reset std_srvs/srv/SetBool`", "create_service(TYPE, '/reset', self.CALLBACK)"],
        ),
        ("        return response\n", "", ["on_reset() answers a service and returns nothing", "return response"]),
    ],
)
def test_why_there_is_no_answer(called, old, new, words):
    assert old in SERVER
    outcome, recording = called(SERVER.replace(old, new))
    assert "arrives" in outcome.failed()
    assert not recording.signal("calls/reset/success")
    assert [word for word in words if word not in outcome.words] == [], outcome.output


@pytest.mark.parametrize(
    ("type", "request_", "words"),
    [
        ("std_srvs/srv/SetBoll", {}, "/reset at 1.2 s.*SetBool"),
        ("std_srvs/srv/SetBool", {"dta": True}, "/reset at 1.2 s.*dta"),
    ],
)
def test_a_call_that_does_not_fit_its_type(type, request_, words):
    from gz_course.grader.run.call_script import request_of

    with pytest.raises(ManifestError, match=words):
        request_of(ScriptedCall(1.2, "/reset", type, request_))


def test_a_run_without_calls_has_no_such_fact(record):
    """Programs that call others leave facts of other names: nothing of these is taken for a call of the script."""
    from gz_course.grader.kinds.kind import find_kind
    from gz_course.grader.score.services_called import service_without_answer

    others = {"called": [{"name": "cos"}], "calls": ["x"]}
    made = record(facts=others)
    assert service_without_answer(made, made.facts()) == ""
    assert service_without_answer in find_kind("node").diagnosis().looks
