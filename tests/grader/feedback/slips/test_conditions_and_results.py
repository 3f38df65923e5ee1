"""Conditions that hold always or never, lost results, times of the wrong sign or fraction: named if certain."""

import pytest

from gz_course.grader.feedback.slips import slips

NONE = """\
class N:
    def __init__(self):
        self.start = None
    def tick(self):
        if self.start is None:
            self.{} = now
"""
FLAG = """\
class N:
    def __init__(self):
        self.moving = {}
    def tick(self):
        if late and not self.moving:
            self.moving = False
"""
ADDED = """\
class N:
    def tick(self):
        now = self.get_clock().now()
        if self.start is None:
            self.start = now
        self.driven {} (now - self.start).nanoseconds / 1e9
{}
"""
SEARCH = """\
def on_scan(self, scan):
    best = math.inf
    for r in scan.ranges:
        if r < best:
            best = r
{}
"""
RESET = """\
def on_scan(self, scan):
    for r in scan.ranges:
        self.near = min(self.near, r)
{}
"""
OVER = """\
class N:
    def over(self):
        {}
    def tick(self):
        if not self.over():
            go()
"""
TIMERS = """\
class N:
    def __init__(self):
        self.timer = self.create_timer(0.1, self.drive)
        self.{} = self.create_timer(5.0, self.stop)
    def stop(self):
        self.timer.cancel()
"""
KEPT = """\
class N:
    def seconds(self):
        stamp = self.get_clock().now().to_msg()
        return stamp.sec + stamp.nanosec / 1e9
    def tick(self):
        if self.zero is None:
            self.zero = self.seconds(){}
        passed = {}
"""
MESSAGES = """\
def __init__(self):
    self.go = Twist()
    self.halt = {}
    self.halt.linear.x = 0.0
def tick(self):
    self.out.publish(self.go)
    self.out.publish(self.halt)
"""
# Words of a slip -> a text with it, and the same without.
SLIPS = {
    "t > 0 or t < 5 holds for every t": ("x = t > 0 or t < 5", "x = t < 0 or t > 5"),
    "t > 5 and t < 0 never holds": ("x = t > 5 and t < 0", "x = t > 0 and t < 5"),
    "holds for every r, because": ("x = r > m.range_min or r < m.range_max", "x = r > m.range_min and r < m.range_max"),
    "m.range_max < r < m.range_min never holds": (
        "x = m.range_max < r < m.range_min", "x = m.range_min < r < m.range_max",
    ),
    "has the same bound twice": ("x = m.range_min <= r <= m.range_min", "x = m.range_min <= r <= m.range_max"),
    "self.start stays None, because the code below sets self.begin": (NONE.format("begin"), NONE.format("start")),
    "start is None here in every call": (
        "def tick():\n    start = None\n    if start is None:\n        start = now()\n",
        "def tick():\n    start = None\n    start = find()\n    if start is None:\n        start = now()\n",
    ),
    "elif t >= 5: is never reached": (
        "if t >= 0:\n    go()\nelif t >= 5:\n    halt()\n", "if t >= 5:\n    halt()\nelif t >= 0:\n    go()\n",
    ),
    "end is computed again from now in every call": (
        "def tick(self):\n    now = clock()\n    end = now + FIVE\n    if now < end:\n        go()\n",
        "def tick(self):\n    end = self.start + FIVE\n    if now < end:\n        go()\n",
    ),
    "self.moving is True from the start, and only these": (FLAG.format("True"), FLAG.format("False")),
    "adds the whole time since self.start in every call": (
        ADDED.format("+=", ""), ADDED.format("+=", "        self.start = now"),
    ),
    "adds the whole time since self.start in": (
        ADDED.format("+=", ""), ADDED.format("+=", "").replace("now", "rate").replace("clock()", "message.z"),
    ),
    "forgets what was found": (SEARCH.format("        else:\n            best = 9.0"), SEARCH.format("")),
    "r < near[0] compares with the first value each time": (
        "for r in near:\n    if r < near[0]:\n        best = r\n",
        "for r in near:\n    if r < best:\n        best = r\n",
    ),
    "time.sleep(0.3) in the loop with spin_once()": (
        "while rclpy.ok():\n    rclpy.spin_once(node)\n    time.sleep(0.3)\n",
        "while rclpy.ok():\n    rclpy.spin_once(node)\n",
    ),
    "which sends self.near: what was found is lost": (
        RESET.format("    self.near = math.inf\n    self.out.publish(Float32(data=self.near))"),
        RESET.format("    self.out.publish(Float32(data=self.near))\n    self.near = math.inf"),
    ),
    "over returns nothing, so self.over() in line 5 is None": (OVER.format("t > 5"), OVER.format("return t > 5")),
    "self.over without brackets is the method itself": (
        OVER.format("return t > 5").replace("self.over()", "self.over"), OVER.format("return t > 5"),
    ),
    "self.done without brackets is the method itself": (
        "class N:\n    def done(self): return 1\n    def tick(self):\n        return self.done and self.near\n",
        "class N:\n    def done(self): return 1\n    def tick(self, call=None):\n        return call or self.done\n",
    ),
    "self.halt without brackets names the function": (
        "class N:\n    def halt(self): go()\n    def tick(self):\n        self.halt\n",
        "class N:\n    def halt(self): go()\n    def tick(self):\n        self.halt()\n",
    ),
    "self.state is never 'stop': line 1 sets it to 'Stop'": (
        "self.state = 'Stop'\nif self.state == 'stop': go()\n", "self.state = 'stop'\nif self.state == 'stop': go()\n",
    ),
    "t > 5 compares and throws the result away": (OVER.format("t > 5"), OVER.format("return t > 5")),
    "self.timer names this timer now": (TIMERS.format("timer"), TIMERS.format("end")),
    "self.zero - self.seconds() is negative": (
        KEPT.format("", "self.zero - self.seconds()"), KEPT.format("", "self.seconds() - self.zero"),
    ),
    "self.zero - now is negative": (
        KEPT.format("", "0\n        now = self.seconds()\n        left = self.zero - now"),
        KEPT.format(" + 5", "0\n        now = self.seconds()\n        left = self.zero - now"),
    ),
    "here it counts as 1e-06 s": (
        "s, n = clock.now().seconds_nanoseconds()\nt = s + n * 1e-6\n",
        "s, n = clock.now().seconds_nanoseconds()\nt = s + n * 1e-9\n",
    ),
    "here it counts as 0.001 s": ("t = stamp.sec + stamp.nanosec / 1000", "t = stamp.sec + stamp.nanosec / 10**9"),
    "a time is hardly ever exactly this one": (
        "if now - start == Duration(seconds=5): pass", "if now - start == Duration(seconds=0): pass",
    ),
    "self.halt = self.go makes no second message": (MESSAGES.format("self.go"), MESSAGES.format("Twist()")),
}  # fmt: skip


@pytest.mark.parametrize("words", SLIPS)
def test_a_certain_mistake_is_named_and_the_right_form_is_not(words):
    wrong, right = SLIPS[words]
    assert any(words in place["said"] for place in slips(wrong.encode())), slips(wrong.encode())
    assert not any(words in place["said"] for place in slips(right.encode()))


def test_a_call_after_and_whose_value_nobody_wants_is_not_found():
    file = """
class A:
    def __init__(self):
        self.create_timer(0.1, lambda: self.scan and self.answer(self.scan))

    def on_scan(self, scan):
        self.scan is None or self.answer(scan)

    def answer(self, scan):
        self.publisher.publish(scan)
"""
    assert slips(file.encode()) == []
    assert (
        "answer returns nothing"
        in slips(file.replace("lambda: self.scan", "lambda: self.answer(1)").encode())[0]["said"]
    )
