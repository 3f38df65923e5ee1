"""Messages that wait for a transform: the ways to lose them, or to wait for ever, and programs that do neither."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """\
class Hit(Node):
    def __init__(self):
        super().__init__("hit")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.waiting = {begin}

    def on_scan(self, scan):
{body}

    def answer(self, one):
        return self.buffer.can_transform("odom", one.header.frame_id, one.header.stamp)
"""


def said(lines, begin="[]"):
    text = NODE.format(begin=begin, body="\n".join(f"        {line}" for line in lines))
    return [place["said"] for place in slips(text.encode())]


def ask(name, of=""):
    return f"t = self.buffer.lookup_transform('odom', {name}.header.frame_id, {of or name}.header.stamp)"


KEEP = "self.waiting.append(scan)"
PEEK = ["first = self.waiting[0]", "stamp = Time.from_msg(first.header.stamp)"]
CAN = "self.buffer.can_transform('odom', first.header.frame_id, stamp)"
TRY = ["    try:", f"        {ask('one')}", "    except TransformException:"]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([KEEP, "while self.waiting:", "    one = self.waiting.pop(0)", *TRY, "        return"], "one leaves"),
        (
            [KEEP, "while len(self.waiting) > 0:", "    one = self.waiting.popleft()", "    self.answer(one)"],
            "one leaves self.waiting here",
        ),
        (
            [KEEP, "for one in list(self.waiting):", "    self.waiting.remove(one)", *TRY, "        continue"],
            "one leaves self.waiting here",
        ),
        (
            [KEEP, "for one in self.waiting:", *TRY, "        continue", "self.waiting.clear()"],
            "this empties self.waiting",
        ),
        ([KEEP, "for one in self.waiting:", "    self.answer(one)", "self.waiting = []"], "this empties self.waiting"),
        (
            [KEEP, "try:", "    for one in self.waiting:", f"        {ask('one')}", "finally:",
             "    self.waiting = []"],
            "this empties self.waiting",
        ),
        (
            [KEEP, "while self.waiting:", *(f"    {each}" for each in PEEK), f"    if not {CAN}:", "        return",
             "    self.waiting.pop(0)"],
            "only the oldest message, self.waiting[0]",
        ),
        (
            [KEEP, "try:", f"    {ask('self.waiting[0]')}", "except E:", "    return", "del self.waiting[0]"],
            "only the oldest message, self.waiting[0]",
        ),
        (
            ["if self.one is None:", "    self.one = scan", "try:", f"    {ask('self.one')}", "except E:",
             "    return", "self.one = None"],
            "only the oldest message, self.one",
        ),
        ([KEEP, "for one in self.waiting:", f"    {ask('one', of='scan')}"], "asks for one, which waits, at the time"),
        (
            [KEEP, "when = Time.from_msg(scan.header.stamp)", "for one in self.waiting[:]:",
             "    t = self.buffer.lookup_transform('odom', 'x', when)"],
            "asks for one, which waits",
        ),
        (["self.waiting[scan.header.stamp.sec] = scan"], "takes the place of the one before"),
    ],
)  # fmt: skip
def test_what_is_lost_or_waits_for_ever(lines, words):
    assert any(words in each for each in said(lines)), said(lines)


@pytest.mark.parametrize(
    "lines",
    [
        [KEEP, "while self.waiting:", "    one = self.waiting.pop(0)", *TRY, "        left.append(one)"],
        [KEEP, "while self.waiting:", "    if not self.answer(self.waiting[0]):", "        self.waiting.popleft()",
         "        continue", "    one = self.waiting.popleft()"],
        [KEEP, "for one in list(self.waiting):", *TRY, "        continue", "    self.waiting.remove(one)"],
        [KEEP, "if len(self.waiting) > 5:", "    one = self.waiting.pop(0)", f"    {ask('one')}"],
        [KEEP, "left = []", "for one in self.waiting:", *TRY, "        left.append(one)", "self.waiting = left"],
        ["all_of = [*self.waiting, scan]", "self.waiting = []", "for one in all_of:", *TRY,
         "        self.waiting.append(one)"],
        [KEEP, "while self.waiting:", *(f"    {each}" for each in PEEK), f"    if not {CAN}:", "        break",
         "    self.waiting.pop(0)", "if len(self.waiting) > 10:", "    self.waiting.pop(0)"],
        [KEEP, *PEEK, "try:", f"    {ask('first')}", "except E:", "    pass", "self.waiting.pop(0)"],
        [KEEP, "for frame in frames:", "    t = self.buffer.lookup_transform('odom', frame, scan.header.stamp)"],
        [KEEP, "for one in self.waiting:", "    stamp = one.header.stamp",
         "    t = self.buffer.lookup_transform('odom', scan.header.frame_id, stamp)"],
        ["key = scan.header.stamp.sec, scan.header.stamp.nanosec", "self.waiting[key] = scan"],
    ],
)  # fmt: skip
def test_who_keeps_what_is_not_done_is_right(lines):
    assert said(lines) == []


def test_a_list_of_limited_length_lets_the_first_go():
    lines = [KEEP, "while self.waiting:", *(f"    {each}" for each in PEEK), f"    if not {CAN}:", "        return",
             "    self.waiting.popleft()"]  # fmt: skip
    assert said(lines, "deque()") and said(lines, "deque(maxlen=5)") == []


FILTER = NODE.format(begin="[]", body="        self.waiting = [one for one in self.waiting if {test}]")
ANSWER = """\
    def reply(self, one):
        try:
            t = self.buffer.lookup_transform("odom", "x", one.header.stamp)
        except TransformException:
            return False
        self.result.publish(t)
        return True
"""


@pytest.mark.parametrize(("test", "wrong"), [("self.reply(one)", True), ("not self.reply(one)", False)])
def test_a_filter_keeps_what_still_waits(test, wrong):
    found = [place["said"] for place in slips((FILTER.replace("{test}", test) + "\n" + ANSWER).encode())]
    assert any("drops what still waits" in each for each in found) is wrong
