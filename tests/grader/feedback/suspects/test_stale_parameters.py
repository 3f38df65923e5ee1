"""Parameters of a wall follower whose new value is not used are suspected; those that are read anew are not."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from sensor_msgs.msg import LaserScan


class Follower:
    def __init__(self):
        self.declare_parameter("distance", 0.6)
        self.far = None
        {init}

    def param(self, name):
        return self.get_parameter(name).value

    def changed(self, parameters):
        for p in parameters:
            {changed}
        return True

    def on_scan(self, scan):
        {scan}
        command.angular.z = self.nearest(scan) - far
"""
HEARS = "self.add_on_set_parameters_callback(self.changed)"
TAKES = "if p.name == 'distance':\n                self.far = p.value"
KEPT = "far = self.far"
READ = "self.far = self.get_parameter('distance').value"
RIGHT = {"init": "pass", "changed": "pass", "scan": "far = self.get_parameter('distance').value"}


def found(**changed):
    return [(each["about"], each["said"]) for each in suspects(FILE.format(**RIGHT | changed).encode())]


@pytest.mark.parametrize(
    "changed",
    [
        {},
        {"scan": "far = self.param('distance')"},
        {"scan": f"{READ}\n        {KEPT}"},
        {"init": f"{HEARS}\n        {READ}", "changed": TAKES, "scan": KEPT},
        {"scan": "far = self.get_parameters(['distance'])[0].value"},
    ],
    ids=str,
)
def test_right_ways(changed):
    assert found(**changed) == []


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"init": READ, "scan": KEPT}, "read only once, in __init__, and on_scan() keeps that value"),
        ({"init": "self.far = self.param('distance')", "scan": KEPT}, "is read only once, in __init__"),
        (
            {"init": "self.far = self.get_parameters(['distance'])[0].value", "scan": KEPT},
            "self.get_parameters(['distance']) is read only once, in __init__",
        ),
        ({"scan": "far = 0.6"}, "nothing reads it later"),
        ({"scan": f"if self.far is None:\n            {READ}\n        {KEPT}"}, "in the block of  if self.far is None"),
        ({"scan": f"if not self.far:\n            {READ}\n        {KEPT}"}, "in the block of  if not self.far"),
        (
            {"init": f"{HEARS}\n        {READ}", "changed": TAKES.replace("'distance'", "'side'"), "scan": KEPT},
            "changed() asks for side alone",
        ),
        (
            {
                "init": f"{HEARS}\n        {READ}",
                "changed": TAKES.replace("'distance'", "'distance' and p.type_ == p.Type.INTEGER"),
                "scan": KEPT,
            },
            "is declared as a DOUBLE",
        ),
        (
            {"init": f"{HEARS}\n        {READ}", "changed": TAKES, "scan": "far = 0.6"},
            "nothing reads self.far later",
        ),
        (
            {"scan": "self.set_parameters([Parameter('distance', value=0.6)])\n        far = self.param('distance')"},
            "sets distance back in each on_scan()",
        ),
    ],
    ids=str,
)
def test_each_is_found(changed, words):
    assert any(about == "parameter distance" and words in said for about, said in found(**changed)), found(**changed)


def test_a_parameter_that_only_a_slow_timer_reads_is_found():
    timer = "self.create_timer(PERIOD, self.read)"
    reads = f"{KEPT}\n\n    def read(self):\n        {READ}"
    slow = found(init=f"{READ}\n        {timer.replace('PERIOD', '5.0')}", scan=reads)
    assert slow[0][0] == "seldom distance" and "is read every 5 s only, by a timer" in slow[0][1]
    assert found(init=f"{READ}\n        {timer.replace('PERIOD', '0.1')}", scan=reads) == []
