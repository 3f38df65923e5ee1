"""Nodes of a submission in other ROS domains: the grader waits for nothing of theirs, and all stay in step."""

import os
import subprocess
import sys

from gz_course.grader.run.pace.real_time import MATCHING, RealTime

APART = """
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
OTHER = (node.context.get_domain_id() + 1) % 100
context = Context()
rclpy.init(context=context, domain_id=OTHER)
apart = Node("apart", context=context, parameter_overrides=[rclpy.parameter.Parameter("use_sim_time", value=True)])
"""
# What it publishes and hears there has the names and types of what the grader hears and publishes.
BESIDE = (
    APART
    + """
from rosgraph_msgs.msg import Clock
said, elsewhere = node.create_publisher(String, "/said", 10), apart.create_publisher(String, "/said", 10)
apart.create_subscription(Clock, "/clock", lambda message: said.publish(String(data="heard")), 10)
count = 0
def tick():
    global count
    count += 1
    said.publish(String(data=str(count)))
    elsewhere.publish(String(data="nobody hears this"))
    apart.get_logger().info("nor this")
node.create_timer(0.1, tick)
executor = SingleThreadedExecutor(context=node.context)
executor.add_node(node)
executor.spin()
"""
)
TALK = (
    APART
    + """
import threading
# Such as grader and submission do not use: they would be made reliable there.
best_effort = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
said = node.create_publisher(String, "/said", 10)
numbers = apart.create_publisher(Int32, "/kept", best_effort)
apart.create_subscription(Int32, "/kept", lambda message: said.publish(String(data=str(message.data))), best_effort)
count = 0
def tick():
    global count
    count += 1
    numbers.publish(Int32(data=count))
node.create_timer(0.1, tick)
executor = SingleThreadedExecutor(context=context)
executor.add_node(apart)
threading.Thread(target=executor.spin, daemon=True).start()
rclpy.spin(node)
"""
)


def test_what_cannot_match_is_not_waited_for(play):
    run = play(simulated=True, both=BESIDE)
    assert (run.heard, run.pace.paced_ticks, run.pace._logs._losses) == ([str(n) for n in range(1, 11)], 0, 0)


def test_two_nodes_of_another_domain_talk_in_step(play):
    run = play(simulated=True, kept=True, both=TALK)
    assert (run.heard, run.pace.paced_ticks) == ([str(n) for n in range(1, 11)], 0)


def test_what_never_matches_is_waited_for_once(play, monkeypatch):
    """Its deadline is one that the grader does not offer."""
    demanding = """
    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile
    said = node.create_publisher(String, "/said", 10)
    node.create_subscription(Int32, "/kept", print, QoSProfile(depth=1, deadline=Duration(seconds=1)))
    others = []
    def tick():
        others.append(node.create_publisher(String, f"/more{len(others)}", 10))
        said.publish(String(data="go on"))
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    waits = []
    await_matches = RealTime.await_matches

    def noted(pace):
        began = pace.processes.clock.now()
        await_matches(pace)
        waits.append(pace.processes.clock.now() - began > MATCHING / 2)

    monkeypatch.setattr(RealTime, "await_matches", noted)
    run = play(simulated=True, kept=True, demanding=demanding)
    assert (run.heard, run.pace.paced_ticks, sum(waits)) == (["go on"] * 10, 0, 1)


def test_the_domain_of_the_run_is_not_what_the_submission_makes_of_it(root):
    code = f"""
import os, sys
sys.path.insert(0, {str(root / "grader/run/agent")!r})
from course_agent import import_hooks, other_domains
import_hooks.install()
os.environ["ROS_DOMAIN_ID"] = "7"
from types import SimpleNamespace
node = lambda domain: SimpleNamespace(context=SimpleNamespace(get_domain_id=lambda: domain))
print(other_domains.apart(node(5)), "|", other_domains.apart(node(7)))
"""
    environment = os.environ | {"ROS_DOMAIN_ID": "5"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert done.stdout == " |  in domain 7\n", done.stderr
