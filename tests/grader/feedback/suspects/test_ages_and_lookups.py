"""Ages of messages that are compared the wrong way round, and lookups whose frames are exchanged."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
def on_scan(self, scan):
    age = (self.get_clock().now() - Time.from_msg(scan.header.stamp)).nanoseconds / 1e9
    if abs(age) > OLDEST:
        self.get_logger().warning("too old")
        return
    frame = scan.header.frame_id
    self.mount = self.frames.lookup_transform(FRAME, frame, Time())

def drive(self):
    command = Twist()
    sent = Time.from_msg(self.wall.header.stamp)
    now = self.get_clock().now()
    waited = now - sent
    if self.wall is not None and waited < OLDEST:
        command.linear.x = GAIN * self.wall.range
    self.publisher.publish(command)
"""


def said(text, about):
    return [each["said"] for each in suspects(text.encode()) if each["about"] == about]


def test_a_right_node_has_none():
    assert said(NODE, "age") == said(NODE, "exchanged_frames") == []


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("abs(age) > OLDEST", "abs(age) < OLDEST", True),
        ("abs(age) > OLDEST", "not age > OLDEST", True),
        ("abs(age) > OLDEST", "OLDEST > age", True),
        ("waited < OLDEST", "waited > OLDEST", True),
        ("waited < OLDEST", "not waited > OLDEST", False),
        ("waited < OLDEST", "OLDEST > waited", False),
        ("waited < OLDEST", "count > OLDEST", False),
        ("waited < OLDEST", "abs(waited) >= 0", False),
        ("waited < OLDEST", "0.0 <= abs(waited)", False),
        ("        return\n", "        self.publisher.publish(Twist())\n        return\n", False),
    ],
)
def test_an_age_that_is_compared_the_wrong_way_round(old, new, found):
    assert bool(said(NODE.replace(old, new), "age")) == found


def test_a_condition_that_holds_for_every_age():
    (words,) = said(NODE.replace("waited < OLDEST", "abs(waited) >= 0"), "any_age")
    assert words == "`abs(waited) >= 0` holds for every age, so no message is too old"


@pytest.mark.parametrize(
    "given",
    [
        "frame, FRAME, Time()",
        "scan.header.frame_id, 'base_link', Time()",
        "source_frame=FRAME, time=Time(), target_frame=scan.header.frame_id",
    ],
)
def test_a_lookup_whose_frames_are_exchanged(given):
    assert "comes first" in said(NODE.replace("FRAME, frame, Time()", given), "exchanged_frames")[0]


@pytest.mark.parametrize(
    ("limit", "found"),
    [
        ("0.5", False),
        ("5.0", False),
        ("1e10", True),
        ("2_000_000_000", True),
        ("float('inf')", True),
        ("math.inf", True),
        ("given()", False),
    ],
)
def test_a_limit_that_no_age_comes_near(limit, found):
    words = said(f"OLDEST = {limit}\n{NODE}", "any_age")
    assert bool(words) == found and all("the limit OLDEST =" in each for each in words)


def test_a_limit_in_nanoseconds_is_none():
    in_nanoseconds = NODE.partition("def drive")[0].replace(".nanoseconds / 1e9", ".nanoseconds")
    assert not said(f"OLDEST = 5e8\n{in_nanoseconds}", "any_age")
    assert said(f"OLDEST = 1e17\n{in_nanoseconds}", "any_age")


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("        return\n", "", True),
        ("        return\n", "        pass\n", True),
        ("        return\n", "    else:\n        self.fresh = scan\n", False),
        ("        return\n", "        self.stop()\n        scan = None\n", False),
    ],
)
def test_an_old_message_that_is_only_reported(old, new, found):
    words = said(NODE.replace(old, new), "any_age")
    assert bool(words) == found and all("only reports an old message" in each for each in words)


@pytest.mark.parametrize(("limit", "found"), [("0.02", True), ("0.1", True), ("0.2", False), ("0", False)])
def test_a_limit_that_nearly_every_age_passes(limit, found):
    words = said(f"OLDEST = {limit}\n{NODE}", "young_age")
    assert bool(words) == found and all(f"the limit OLDEST = {limit} in" in each for each in words)
