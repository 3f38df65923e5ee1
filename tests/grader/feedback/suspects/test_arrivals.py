"""Conditions by which a waypoint counts as reached, and feedback that comes too seldom."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Server(Node):
    def execute(self, handle):
        told = self.now()
        for index, waypoint in enumerate(handle.request.waypoints):
            while hypot(waypoint.x - self.x, waypoint.y - self.y) > NEAR:
                dx, dy = waypoint.x - self.x, waypoint.y - self.y
                handle.publish_feedback(self.feedback(index, dx, dy))
                self.publisher.publish(self.command(dx, dy))
                time.sleep(0.1)
        handle.succeed()
        return Patrol.Result()
"""
LOOP = "while hypot(waypoint.x - self.x, waypoint.y - self.y) > NEAR:"
STEP = "                dx, dy = waypoint.x - self.x, waypoint.y - self.y\n"
FEEDBACK = "                handle.publish_feedback(self.feedback(index, dx, dy))\n"
METHOD = """
    def arrived(self, dx, dy):
        x_there = abs(dx) < NEAR
        y_there = abs(dy) < NEAR
        return x_there {} y_there
"""


def said(source, about):
    return " ".join(each["said"] for each in suspects(source.encode()) if each["about"] == about)


def test_a_right_server_has_none():
    assert suspects(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("loop", "words"),
    [
        ("while abs(waypoint.x - self.x) > NEAR and abs(waypoint.y - self.y) > NEAR:", "x or y alone is near"),
        ("while rclpy.ok() and abs(dx) > NEAR and NEAR < abs(dy):", "x or y alone is near"),
        ("while not (abs(dx) < NEAR or fabs(dy) < NEAR):", "x or y alone is near"),
        ("while min(abs(error[0]), abs(error[1])) > NEAR:", "x or y alone is near"),
        ("while abs(waypoint.x - self.x) > NEAR:", "and y may be far off"),
        ("while dx > NEAR or dy > NEAR:", "with their signs"),
        ("while waypoint.x - self.x > NEAR or waypoint.y - self.y > NEAR:", "with their signs"),
        ("while abs(waypoint.x - self.x) > NEAR or abs(waypoint.y - self.y) > NEAR:", ""),
        ("while not (abs(dx) < NEAR and abs(dy) < NEAR):", ""),
        ("while max(abs(dx), abs(dy)) > NEAR:", ""),
        ("while abs(turn) > NEAR and abs(left) > NEAR:", ""),
        ("while any(abs(x - a) > NEAR and abs(y - b) > NEAR for a, b in self.posts):", ""),
    ],
)
def test_conditions_of_arrival(loop, words):
    found = said(RIGHT.replace(LOOP, loop), "one_axis")
    assert words in found and bool(words) == bool(found)


def test_a_condition_in_a_method():
    loop = RIGHT.replace(LOOP, "while not self.arrived(dx, dy):")
    assert "`x_there or y_there` is true" in said(loop + METHOD.format("or"), "one_axis")
    assert said(loop + METHOD.format("and"), "one_axis") == ""


def test_a_break_on_differences_with_their_signs():
    left = RIGHT.replace(STEP, STEP + "                if dx < NEAR and dy < NEAR:\n                    break\n")
    assert "with their signs" in said(left, "one_axis")


def test_feedback_outside_of_the_loop_that_drives():
    before = "            handle.publish_feedback(self.feedback(index, 0, 0))\n            while"
    words = said(RIGHT.replace(FEEDBACK, "").replace("            while", before), "rare_feedback")
    assert "publish_feedback() stands outside of the loop of line 6" in words
    method = "\n    def tell(self, handle, index):\n        handle.publish_feedback(self.feedback(index, 0, 0))\n"
    after = "            self.tell(handle, index)\n        handle.succeed()"
    called = RIGHT.replace(FEEDBACK, "").replace("        handle.succeed()", after) + method
    assert "tell() stands outside" in said(called, "rare_feedback")
    inside = RIGHT.replace(FEEDBACK, "                self.tell(handle, index)\n") + method
    assert said(inside, "rare_feedback") == ""


def test_feedback_under_a_condition():
    changed = FEEDBACK.replace("handle.", "if index != told:\n                    handle.", 1)
    assert "only if `index != told`" in said(RIGHT.replace(FEEDBACK, changed), "rare_feedback")
    rate = FEEDBACK.replace("handle.", "if self.now() - told > 0.5:\n                    handle.", 1)
    assert said(RIGHT.replace(FEEDBACK, rate), "rare_feedback") == ""


def test_a_loop_that_goes_on_while_the_robot_is_near():
    assert "goes on while the robot is near" in said(RIGHT.replace("> NEAR", "< NEAR"), "inverted")
    assert said(RIGHT.replace(LOOP, "while self.gone < leg:"), "inverted") == ""


@pytest.mark.parametrize(
    ("loop", "found"),
    [
        ("while dx * dx + dy * dy > 0.15:", True),
        ("while math.hypot(dx, dy) ** 2 > 0.1:", True),
        ("while dx**2 + dy**2 > 0.15**2:", False),
        ("while dx**2 + dy**2 > 0.01:", False),
        ("while math.hypot(dx, dy) > 0.15:", False),
    ],
)
def test_the_square_of_a_distance(loop, found):
    assert bool(said(RIGHT.replace(LOOP, loop), "squared")) == found
