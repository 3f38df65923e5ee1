"""What right programs were once accused of, and what is still wrong beside it."""

from gz_course.grader.feedback.launch_files import launch_places
from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.suspects import suspects

GENERATOR = """\
def main():
    node = rclpy.create_node("teleop")
    steps = commands(node.get_clock())
    node.create_timer(0.1, lambda: out.publish(next(steps)))
    rclpy.spin(node)

def commands(clock):
    begin = clock.now()
    while (clock.now() - begin).nanoseconds < 5e9:
        {round}
"""
AGE = """\
class Points(Node):
    def on_point(self, point):
        when = Time.from_msg(point.header.stamp)
        if (self.get_clock().now() - when).nanoseconds > {limit}:
            return
        self.out.publish(point)
"""
KEEPS = """\
class Keeper(Node):
    def __init__(self):
        super().__init__("keeper")
        self.still = []
        self.create_subscription(Odd, "/topic", self.heard, 10)

    def heard(self, message):
        if len(self.still) < 100:
            self.still.append({value})
"""
DRIVES = """\
class Tuned(Node):
    def __init__(self):
        super().__init__("tuned")
        {first}
        self.create_timer(0.1, self.work)

    def work(self):
        command = Twist()
        command.linear.x = 0.5
        self.publisher.publish(command)
"""


def about(source, what):
    return [each for each in suspects(source.encode()) if each["about"] == what]


def test_a_loop_of_a_generator_waits_for_nobody():
    def said(round):
        return [
            each for each in slips(GENERATOR.format(round=round).encode()) if "before anything spins" in each["said"]
        ]

    assert said("yield Twist()") == []
    assert said("out.publish(Twist())") != []


def test_a_limit_of_nanoseconds_may_be_a_product():
    assert about(AGE.format(limit="2.0 * 1e9"), "any_age") == []
    assert about(AGE.format(limit="1e15"), "any_age") != []


def test_one_field_is_no_place_that_has_to_be_turned():
    assert about(KEEPS.format(value="message.angular_velocity.z"), "unturned") == []
    assert about(KEEPS.format(value="(message.x, message.y)"), "unturned") != []


def test_a_node_that_is_tuned_drives_for_no_time():
    assert about(DRIVES.format(first="self.declare_parameters('', [('gain', 0.5)])"), "endless") == []
    assert about(DRIVES.format(first="pass"), "endless") != []


def test_a_parameter_of_the_bridge_may_have_any_name():
    def said(value):
        run = "ExecuteProcess(cmd=['ros2', 'run', 'ros_gz_bridge', 'parameter_bridge', '--ros-args', '-p', thing])"
        source = f"def generate_launch_description():\n    thing = {value}\n    return LaunchDescription([{run}])\n"
        return launch_places(source.encode())["launch_slips"]

    assert said("f\"config_file:={folder / 'bridge.yaml'}\"") == []
    assert "arguments of parameter_bridge are topics" in said("str(folder / 'bridge.yaml')")[0]["said"]
