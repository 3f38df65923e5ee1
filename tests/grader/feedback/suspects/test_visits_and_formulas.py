"""Waypoints that count too early, goals that wait for their turn, and formulas that give no heading."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Server(Node):
    def __init__(self):
        self.busy = False
        self.turn = threading.Lock()
        self.server = ActionServer(self, Patrol, "patrol", self.execute, goal_callback=self.judge)

    def odometry(self, message):
        q = message.pose.pose.orientation
        sine = 2.0 * (q.w * q.z + q.x * q.y)
        self.heading = math.atan2(sine, 1.0 - 2.0 * (q.y * q.y + q.z * q.z))

    def execute(self, handle):
        self.busy = True
        visited = 0
        for index, waypoint in enumerate(handle.request.waypoints):
            while self.left(waypoint) > 0.1:
                if handle.is_cancel_requested:
                    handle.canceled()
                    return Patrol.Result(visited=visited)
                time.sleep(0.1)
            visited += 1
        handle.succeed()
        return Patrol.Result(visited=visited)
"""
LOOP = "            while self.left(waypoint) > 0.1:\n"
CANCELLED = "                    return Patrol.Result(visited=visited)"
BUSY = "        self.busy = True\n"


def said(source, about):
    return [each["said"] for each in suspects(source.encode()) if each["about"] == about]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (LOOP, f"            visited += 1\n{LOOP}", "counts the waypoint before line 17 drives to it"),
        (LOOP, f"            visited = index + 1\n{LOOP}", "counts the waypoint before line 17 drives to it"),
        (CANCELLED, CANCELLED.replace("=visited", "=len(handle.request.waypoints)"), "all waypoints of the goal"),
        (CANCELLED, CANCELLED.replace("=visited", "=index + 1"), "`index` have been visited"),
    ],
)
def test_waypoints_that_count_too_early(old, new, words):
    assert not said(RIGHT, "counted")
    found = said(RIGHT.replace(old, new), "counted")
    assert len(found) == 1 and words in found[0]


BREAK = """\
                if handle.is_cancel_requested:
                    break
                time.sleep(0.1)
"""
RETURN = RIGHT[RIGHT.index("                if handle.is") : RIGHT.index("            visited += 1")]
IN_A_CONDITION = LOOP.replace(":\n", " and not handle.is_cancel_requested:\n")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ([(RETURN, BREAK)], "this break leaves only the inner loop when the goal is cancelled; then line 20"),
        ([(RETURN, BREAK), ("            visited +=", "            if handle.is_cancel_requested:\n" + " " * 16
          + "break\n            visited +=")], ""),
        ([(LOOP, IN_A_CONDITION), (RETURN, "                time.sleep(0.1)\n")], "ends when the goal is cancelled"),
        ([(RETURN, BREAK.replace("    break", "    gone = True\n" + " " * 20 + "break"))], "this break leaves only"),
        ([(RETURN, BREAK.replace("    break", "    gone = True\n" + " " * 20 + "break")),
          ("            visited +=", "            if gone:\n                break\n            visited +=")], ""),
        ([(RETURN, BREAK), ("            visited += 1", "            else:\n                visited += 1")], ""),
    ],
)  # fmt: skip
def test_a_cancellation_that_leaves_one_loop_of_two(changes, words):
    source = RIGHT
    for old, new in changes:
        assert old in source
        source = source.replace(old, new)
    found = said(source, "counted")
    assert bool(found) == bool(words) and words in " ".join(found)


def test_a_function_that_returns_when_a_goal_is_cancelled_and_is_not_asked_why():
    drive = """
    def drive(self, handle, waypoint):
        while self.left(waypoint) > 0.1:
            if handle.is_cancel_requested:
                return False
            time.sleep(0.1)
        return True
"""
    inner = RIGHT[RIGHT.index(LOOP) : RIGHT.index("            visited += 1")]
    dropped = RIGHT.replace(inner, "            self.drive(handle, waypoint)\n") + drive
    assert "drive() returns when the goal is cancelled" in " ".join(said(dropped, "counted"))
    asked = "            if not self.drive(handle, waypoint):\n                break\n"
    assert not said(RIGHT.replace(inner, asked) + drive, "counted")


@pytest.mark.parametrize(
    ("waits", "name"),
    [
        ("        self.turn.acquire()\n", "self.turn"),
        ("        while self.busy:\n            time.sleep(0.1)\n", "self.busy"),
    ],
)
def test_goals_that_wait_for_their_turn(waits, name):
    assert not said(RIGHT, "queued")
    found = said(RIGHT.replace(BUSY, waits + BUSY), "queued")
    assert len(found) == 1 and f"waits here for {name}" in found[0]


def test_a_lock_that_is_taken_at_the_end_lets_no_goal_wait():
    end = "        handle.succeed()\n        return Patrol.Result(visited=visited)\n"
    held = "        with self.turn:\n            handle.succeed()\n            return Patrol.Result(visited=visited)\n"
    assert end in RIGHT and not said(RIGHT.replace(end, held), "queued")


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("math.atan2(sine, 1.0 - 2.0 * (q.y * q.y + q.z * q.z))", ""),
        ("2 * math.atan2(q.z, q.w)", ""),
        ("math.degrees(2 * math.asin(q.z))", ""),
        ("math.asin(2.0 * (q.w * q.y - q.z * q.x))", "is always 0 on flat ground"),
        ("math.atan2(1.0 - 2.0 * (q.y ** 2 + q.z ** 2), sine)", "gives 0.57 where a robot has turned by 1 rad"),
        ("math.atan2(-sine, 1.0 - 2.0 * q.z * q.z)", "has the wrong sign"),
        ("math.atan2(sine, q.w * q.w + q.z * q.z)", "gives 0.70 where a robot has turned by 1 rad"),
        ("math.atan2(sine, self.scale)", ""),
    ],
)
def test_formulas_that_give_no_heading(formula, words):
    found = said(RIGHT.replace("math.atan2(sine, 1.0 - 2.0 * (q.y * q.y + q.z * q.z))", formula), "heading")
    assert (words in found[0]) if words else not found, found


def test_a_flag_that_stays_true_for_the_next_waypoint():
    flagged = RIGHT.replace("self.left(waypoint) > 0.1", "not self.arrived")
    flagged += "\n    def step(self):\n        self.arrived = True\n"
    assert any("self.arrived stays True from the first waypoint on" in each for each in said(flagged, "left_early"))
    assert not said(flagged.replace(BUSY, f"{BUSY}        self.arrived = False\n"), "left_early")


def test_a_cancel_callback_that_refuses():
    refusing = RIGHT.replace("goal_callback=self.judge", "cancel_callback=self.answer")
    refusing += "\n    def answer(self, handle):\n        return CancelResponse.ANSWER\n"
    assert not said(refusing.replace("ANSWER", "ACCEPT"), "refuses_cancel")
    assert "in answer refuses" in said(refusing.replace("ANSWER", "REJECT"), "refuses_cancel")[0]


def test_a_count_that_is_a_float():
    assert not said(RIGHT, "unsent_result")
    broken = RIGHT.replace(CANCELLED, CANCELLED.replace("=visited", "=float(visited)"))
    assert "the field visited is an int32" in said(broken, "unsent_result")[0]
