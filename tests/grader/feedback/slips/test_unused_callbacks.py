"""Callbacks that no subscription names, although they alone set what a timer reads."""

from gz_course.grader.feedback.slips import slips

RIGHT = """\
class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.own = None
        self.front = Pose()
        self.create_subscription(Odometry, "odom", self.on_own, 10)
        self.create_subscription(Odometry, "front/odom", callback=self.on_front, qos_profile=10)
        self.create_timer(0.1, self.steer)

    def on_own(self, message):
        self.own = message.pose.pose

    def on_front(self, message):
        self.front = message.pose.pose

    def steer(self):
        if self.own is not None:
            self.publisher.publish(self.command(self.own, self.front))


rclpy.spin(Follower())
"""
SECOND = '        self.create_subscription(Odometry, "front/odom", callback=self.on_front, qos_profile=10)\n'


def said(text):
    return [f"{each['line']}: {each['said']}" for each in slips(text.encode())]


def test_a_callback_that_is_named_is_right():
    assert said(RIGHT) == []
    assert said(RIGHT.replace("self.on_front, qos", "getattr(self, 'on_front'), qos")) == []


def test_one_callback_is_passed_twice():
    found = said(RIGHT.replace("callback=self.on_front, qos", "callback=self.on_own, qos"))
    assert "7: this subscription calls self.on_own, as that of line 6 does, and nothing calls on_front" in found[0]


def test_a_subscription_is_missing():
    assert "nothing calls on_front, which alone sets self.front" in said(RIGHT.replace(SECOND, ""))[0]


def test_what_another_method_sets_too_is_not_lost():
    both = RIGHT.replace("self.own = message.pose.pose", "self.own = self.front = message.pose.pose")
    assert said(both.replace(SECOND, "")) == []
