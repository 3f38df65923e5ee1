"""Lines that make what a node sends, and the conditions before it sends."""

from textwrap import dedent

import pytest

from gz_course.grader.feedback.facts.origins import MOST, before_speeds, conditions, of_the_drive, origins

NODE = """
class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.out = self.create_publisher(Float32, "nearest", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.offset = 0.2
        self.speed = 0.7

    def on_scan(self, scan):
        unused = scan.range_max * 2.0
        valid = scan.ranges[10:20]
        if not valid:
            return
        self.tell(min(valid))

    def tell(self, nearest):
        if self.done:
            self.out.publish(Float32(data=self.less(nearest)))

    def less(self, value):
        return value - self.offset
"""


def lines(places: list[dict[str, object]]) -> dict[object, object]:
    return {place["line"]: place["code"] for place in places}


def test_origins_lead_through_functions_and_attributes() -> None:
    assert lines(origins(NODE.encode())) == {
        7: "self.offset = 0.2",
        12: "valid = scan.ranges[10:20]",
        15: "self.tell(min(valid))",
        22: "return value - self.offset",
    }


def test_conditions_stand_before_publish_and_before_the_call_of_its_function() -> None:
    found = conditions(NODE.encode())
    assert lines(found) == {13: "if not valid: return", 18: "if self.done:"}
    assert {place["topic"] for place in found} == {"/nearest"}
    assert {place["sends"] for place in found} == {19}


def test_the_other_branch_is_named_as_such() -> None:
    text = dedent(
        """
        def tick():
            if ready:
                pass
            else:
                out.publish(String())
        """
    )
    assert lines(conditions(text.encode())) == {3: "else of if ready:"}


def test_logs_count_where_nothing_is_published() -> None:
    text = dedent(
        """
        def on_scan(self, scan):
            mean = sum(scan.ranges) / 360
            self.get_logger().info(f"{mean:.2f}")
        """
    )
    assert lines(origins(text.encode())) == {3: "mean = sum(scan.ranges) / 360"}


def test_too_many_lines_are_none() -> None:
    steps = "\n".join(f"    a = a + {n}" for n in range(MOST + 1))
    assert origins(f"def tick(a):\n{steps}\n    out.publish(a)\n".encode()) == []


@pytest.mark.parametrize("content", [b"", b"def", b"\xff", b"out.publish()", b"publish(1.0)", b"x" * 10_000 + b"("])
def test_nothing_is_found_where_nothing_is_sent(content: bytes) -> None:
    assert origins(content) == []
    assert conditions(content) == []


def test_long_code_is_cut() -> None:
    (place,) = origins(b"out.publish(" + b" + ".join([b"value"] * 50) + b")")
    assert place["code"].startswith("out.publish(value + value") and place["code"].endswith("...")


def test_what_stands_before_a_speed_is_listed():
    text = "def f(age, c):\n    if age < 1:\n        c.linear.x = age\n    else:\n        c.linear.x = 0.0\n"
    assert before_speeds(text.encode()) == [{"line": 2, "code": "if age < 1:"}]


def test_the_condition_on_which_a_drive_goes_on():
    text = b"def tick():\n    if start is None:\n        begin()\n    if passed < 5:\n        out.linear.x = 0.5\n"
    assert of_the_drive(text) == [{"line": 4, "code": "if passed < 5:"}]
    assert of_the_drive(text.replace(b"0.5", b"0.0")) == []
