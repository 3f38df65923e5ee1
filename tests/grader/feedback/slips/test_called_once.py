"""Methods that __init__ calls once, before any message can have come."""

from gz_course.grader.feedback.slips import slips

WRONG = """\
class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.front = None
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "front/odom", self.on_front, 10)
        self.steer()

    def on_front(self, message):
        self.front = message.pose.pose

    def steer(self):
        if self.front is None:
            return
        self.publisher.publish(Twist())


rclpy.spin(Follower())
"""


def said(text):
    return [f"{each['line']}: {each['said']}" for each in slips(text.encode())]


def test_a_method_that_is_called_once_too_early():
    assert any(each.startswith("7: steer is called once") for each in said(WRONG))


def test_a_method_that_something_calls_again():
    assert said(WRONG.replace("self.steer()\n\n", "self.create_timer(0.1, self.steer)\n\n")) == []
    assert said(WRONG.replace("= message.pose.pose", "= message.pose.pose\n        self.steer()")) == []
    assert said(WRONG.replace("        if self.front is None:\n            return\n", "")) == []
