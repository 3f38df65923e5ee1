"""Misuse of tf2: what a file asks for, and the ways in which it can never get it."""

import pytest

from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.slips.nodes.transforms import lookups, shared_headers

NODE = """\
class Hit(Node):
    def __init__(self):
        super().__init__("hit")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.waiting = []

    def on_scan(self, scan):
{body}
"""
ASK = "self.buffer.lookup_transform('odom', scan.header.frame_id, Time.from_msg(scan.header.stamp))"
LATEST = "self.buffer.can_transform('odom', scan.header.frame_id, Time())"


def node(*lines):
    return NODE.format(body="\n".join(f"        {line}" for line in lines))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (node("self.buffer = Buffer()", f"t = {ASK}"), "makes a new Buffer each time"),
        (
            node(f"t = {ASK}").replace("        self.listener = TransformListener(self.buffer, self)\n", ""),
            "nothing fills",
        ),
        (node("while not self.buffer.can_transform('odom', 'x', Time()):", "    pass"), "it never ends"),
        (node(f"if {LATEST}:", f"    t = {ASK}"), "ask both for the same time"),
        (
            node("while True:", "    try:", f"        t = {ASK}", "        break", "    except E:", "        pass"),
            "never ends",
        ),
        (node("rclpy.spin_once(self)", f"t = {ASK}"), "cannot be spun again"),
        (
            node("now = self.get_clock().now()", "t = self.buffer.lookup_transform('odom', 'x', now)"),
            "this very moment",
        ),
        (node("t = self.buffer.lookup_transform(FRAME, FRAME, Time())"), "both frames of this lookup are FRAME"),
    ],
)
def test_what_can_never_work_is_a_slip(text, words):
    assert any(words in place["said"] for place in slips(text.encode()))


@pytest.mark.parametrize(
    "lines",
    [
        [f"t = {ASK}"],
        ["if self.buffer is None:", "    self.buffer = Buffer()", f"t = {ASK}"],
        [
            *(
                "while True:",
                "    try:",
                "        scan = self.queue.get_nowait()",
                "    except Empty:",
                "        break",
            ),
            *("    try:", f"        t = {ASK}", "    except E:", "        again.append(scan)"),
        ],
        ["while True:", "    try:", f"        t = {ASK}", "    except E:", "        return"],
        ["for scan in self.waiting:", "    if self.buffer.can_transform('odom', 'x', Time()):", f"        t = {ASK}"],
    ],
)
def test_what_may_work_is_none(lines):
    assert slips(node(*lines).encode()) == []


def test_frames_that_are_written_down_and_scans_that_are_given_up():
    assert lookups(node(f"t = {ASK}").encode()) == [{"line": 10, "frames": ["odom"], "gives_up": True}]
    assert not lookups(node("self.waiting.append(scan)", f"t = {ASK}").encode())[0]["gives_up"]
    assert not lookups(node("t = self.buffer.lookup_transform('odom', 'x', Time())").encode())[0]["gives_up"]
    text = node("frame = 'map'", "p = self.buffer.transform(point, frame)")
    assert lookups(text.encode()) == [{"line": 11, "frames": ["map"], "gives_up": True}]
    assert lookups(b"x = (") == []
    part = node(f"t = {ASK}").replace("scan.header.frame_id", "scan.header.frame_id.split('/')[-1]")
    assert lookups(part.encode())[0]["altered"] == "scan.header.frame_id.split('/')[-1]"
    same = node(f"t = {ASK}").replace("scan.header.frame_id", "scan.header.frame_id.lstrip('/')")
    assert "altered" not in lookups(same.encode())[0]


@pytest.mark.parametrize(
    ("lines", "gives_up"),
    [
        (["self.last = scan", f"t = {ASK}"], True),
        (
            ["self.last = scan", "self.try_it()", "", "def try_it(self):", "    scan = self.last", f"    t = {ASK}"],
            True,
        ),
        (["scan, self.last = self.last, scan", f"t = {ASK}"], False),
        (["old = self.last", "self.last = scan", "scan = old", f"t = {ASK}"], False),
        (["if self.last is None:", "    self.last = scan", f"t = {ASK}"], False),
        (["await self.ready(scan)", f"t = {ASK}"], False),
    ],
)
def test_who_asks_for_the_newest_scan_alone_gives_the_others_up(lines, gives_up):
    text = node(*lines)
    text = text.replace("def on_scan", "async def on_scan") if "await" in text else text
    assert lookups(text.encode())[0]["gives_up"] is gives_up


def test_a_timer_that_asks_has_kept_a_point():
    kept = node("point = PointStamped()", "self.point = [point]", "", "def ask(self):", "    t = " + ASK)
    assert lookups(kept.encode())[0]["gives_up"]
    timed = kept.replace("        self.waiting = []", "        self.create_timer(0.1, self.ask)")
    assert not lookups(timed.encode())[0]["gives_up"]


def test_a_header_of_two_messages_is_found():
    lines = ["hit.header = scan.header", "hit.header.frame_id = 'odom'"]
    assert shared_headers(node(*lines).encode()) == [{"line": 11}]
    assert shared_headers(node(lines[1]).encode()) == shared_headers(node(lines[0]).encode()) == []
