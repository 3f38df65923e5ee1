"""ROS parameters that are compared as objects, refused, read too early or declared under another name."""

import pytest

from gz_course.grader.feedback.slips import slips

FILE = """\
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.declare_parameter("distance", 0.6)
        self.declare_parameter("side", "left")
        self.declare_parameter("speed_limit", 0.5)
        {init}

    def read(self):
        self.far = self.get_parameter("distance").value

    def changed(self, parameters):
        {changed}
        return {result}

    def on_scan(self, scan):
        {scan}
        self.publisher.publish(scan)
"""
HEARS = "self.add_on_set_parameters_callback(self.changed)"
TAKES = (
    "for p in parameters:\n            if p.name == 'distance':\n                self.far = p.value\n"
    "            elif p.name == 'side':\n                self.side = p.value\n"
    "            else:\n                self.limit = p.value"
)
RIGHT = {
    "init": HEARS,
    "changed": TAKES,
    "result": "SetParametersResult(successful=True)",
    "scan": "left = self.get_parameter('side').value == 'left'",
}


def said(**changed):
    return [place["said"] for place in slips(FILE.format(**RIGHT | changed).encode())]


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"scan": "side = self.get_parameter('side')\n        left = side.value == 'left'"},
        {"scan": "far = self.get_parameter('distance').get_parameter_value().double_value"},
        {"scan": "left = self.get_parameter('side').value.lower() in ('left', 'Left')"},
        {"scan": "left = self.get_parameter('side').value in ('left', 'Left')"},
        {"result": "SetParametersResult(successful=self.far > 0)"},
        {"result": "result", "changed": "result = SetParametersResult()\n        result.successful = True"},
        {"changed": TAKES + "\n        self.after = self.far"},
        {"init": HEARS + "\n        self.far = self.get_parameter('distance').value"},
        {"init": "self.add_post_set_parameters_callback(self.changed)", "changed": "self.read()", "result": "None"},
    ],
    ids=str,
)
def test_right_ways(changed):
    assert said(**changed) == []


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"scan": "left = self.get_parameter('side') == 'left'"}, "never holds: get_parameter() returns a Parameter"),
        ({"scan": "left = 'left' != self.get_parameter('side')"}, "always holds: get_parameter() returns a Parameter"),
        ({"scan": "side = self.get_parameter('side')\n        left = side in ('left', 'l')"}, "side is a Parameter"),
        ({"scan": "left = 1 if self.get_parameter('side') else 0"}, "always counts as true"),
        ({"scan": "left = self.get_parameter('side').get_parameter_value() == 'left'"}, "a field for each type"),
        ({"scan": "left = str(self.get_parameter('side')) == 'left'"}, "str() of a Parameter"),
        ({"scan": "d = self.get_parameter('distance').get_parameter_value().integer_value"}, "is in double_value"),
        ({"scan": "left = self.get_parameter('side').value == 'LEFT'"}, "'LEFT' is another text"),
        ({"scan": "sign = 1 if self.get_parameter('side').value else -1"}, "is a text and counts as true"),
        ({"scan": "side = self.get_parameter('side').value\n        sign = 1 if side else -1"}, "side is a text"),
        ({"scan": "far = int(self.get_parameter('distance').value)"}, "a whole number of a parameter, 0 of 0.6"),
        ({"result": "SetParametersResult()"}, "refuses the new value"),
        ({"init": "pass"}, "changed() is not called when a parameter changes"),
        ({"changed": TAKES.replace("p.name == 'side'", "p == 'side'")}, "p is a Parameter"),
        ({"changed": "if 'distance' in parameters:\n            self.read_all()"}, "a list of Parameter objects"),
        ({"changed": "self.now = self.get_parameter('distance').value"}, "changed() is called before the new value"),
        ({"changed": "self.read()"}, "changed(), which calls read(), is called before the new value"),
        ({"changed": TAKES.replace("self.limit", "self.far")}, "puts the value of another parameter into what line"),
        ({"changed": "self.far = parameters[0].value"}, "distance and of side and of speed_limit alike"),
        ({"changed": TAKES.replace("elif", "if")}, "distance and of speed_limit alike"),
    ],
    ids=str,
)
def test_each_is_found(changed, words):
    places = said(**changed)
    assert any(words in each for each in places), places


def test_a_parameter_under_another_name_is_found_if_the_exercise_has_one_like_it():
    content = b"node.declare_parameter('wall_side', 'left')\nnode.declare_parameter('distance', 0.6)"
    (place,) = slips(content, names=("distance", "side"))
    assert place["line"] == 1 and "the task calls it side" in place["said"]
    assert slips(content, names=("distance", "rate")) == slips(content) == []


def test_a_field_of_another_type_by_way_of_a_function_of_the_file():
    file = """
class A:
    def __init__(self):
        for name, default in {"distance": 0.6, "side": "left"}.items():
            self.declare_parameter(name, default)

    def asked(self, name):
        return self.get_parameter(name).get_parameter_value()

    def on_scan(self, scan):
        return self.asked("distance").FIELD
"""
    (said,) = [each["said"] for each in slips(file.replace("FIELD", "integer_value").encode())]
    assert "integer_value of the parameter distance is never set" in said
    assert slips(file.replace("FIELD", "double_value").encode()) == []


def test_a_parameter_that_is_set_over_what_was_given_is_found():
    sets = "self.set_parameters([rclpy.parameter.Parameter('distance', value=0.6)])"
    assert any("replaces the value that the node was started with" in each for each in said(init=sets))
    assert not any("replaces the value" in each for each in said(init=sets.replace("value=0.6", "value=far")))
