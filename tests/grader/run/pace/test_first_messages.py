"""What a node publishes before its process has waited is lost, always: nobody has found the publisher yet."""

import pytest

from gz_course.grader.run.agent.course_agent.python_3_threads import THREADS
from gz_course.grader.run.agent.course_agent.self_check import misfits

SPEAKS_AT_ONCE = """
said = node.create_publisher(String, "/said", 10)
said.publish(String(data="at once"))
said.publish(String(data="and again"))
node.create_timer(0.3, lambda: said.publish(String(data="later")))
rclpy.spin(node)
"""
# Far longer than DDS needs to connect the two: it is not luck that the message is lost.
LINGERS = SPEAKS_AT_ONCE.replace("said.publish", "sum(range(3 * 10**7))\nsaid.publish", 1)


@pytest.fixture
def late(monkeypatch):
    """Let the grader's subscriptions come long after those of the node."""
    from gz_course.grader.run.agent.course_agent.thread_monitor import sleep
    from gz_course.grader.run.grader_endpoints import GraderEndpoints

    begin = GraderEndpoints.__init__

    def later(*arguments, **options):
        sleep(3.0)  # the node starts up meanwhile
        begin(*arguments, **options)

    monkeypatch.setattr(GraderEndpoints, "__init__", later)


def test_it_is_lost_and_counted_and_what_comes_later_arrives(play):
    played = play(ticks=4, holding=False, simulated=True, node=SPEAKS_AT_ONCE)
    assert played.heard == ["later"]
    assert played.too_early == {"/said": 2}
    assert played.pace.paced_ticks == 0


@pytest.mark.proof
def test_so_it_is_when_dds_has_long_connected_the_two(play):
    played = play(ticks=4, holding=False, simulated=True, node=LINGERS)
    assert (played.heard, played.too_early) == (["later"], {"/said": 2})


def test_so_it_is_when_the_listener_comes_late(play, late):
    played = play(ticks=4, holding=False, simulated=True, node=SPEAKS_AT_ONCE)
    assert (played.heard, played.too_early) == (["later"], {"/said": 2})


@pytest.mark.proof
@pytest.mark.parametrize("number", range(10))
@pytest.mark.parametrize("simulated", [True, False])
def test_ten_times_on_either_side(play, late, number, simulated):
    for code in (SPEAKS_AT_ONCE, LINGERS):
        played = play(ticks=4, holding=number % 2 == 0, simulated=simulated, node=code)
        assert (played.heard, played.too_early) == (["later"], {"/said": 2})


def test_a_publisher_that_is_made_in_a_callback_is_found_when_the_callback_is_over(play):
    code = """
    said = []
    def tick():
        if not said:
            said.append(node.create_publisher(String, "/said", 10))
            said[0].publish(String(data="made"))
        else:
            said[0].publish(String(data="found"))
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    played = play(ticks=3, holding=False, simulated=True, node=code)
    assert (played.heard, played.too_early) == (["found", "found"], {"/said": 1})


def test_who_sleeps_first_is_found(play):
    code = """
    import time
    said = node.create_publisher(String, "/said", 10)
    time.sleep(0.2)
    said.publish(String(data="found"))
    rclpy.spin(node)
    """
    played = play(ticks=4, holding=False, simulated=True, node=code)
    assert (played.heard, played.too_early) == (["found"], {})


def test_a_subscription_in_the_same_process_hears_it(play):
    code = """
    said = node.create_publisher(String, "/said", 10)
    own = node.create_publisher(String, "/own", 10)
    heard = []
    node.create_subscription(String, "/own", lambda m: heard.append(m.data), 10)
    own.publish(String(data="first"))
    node.create_timer(0.1, lambda: own.publish(String(data="timer")))
    node.create_timer(0.2, lambda: said.publish(String(data=" ".join(heard))))
    rclpy.spin(node)
    """
    played = play(ticks=2, holding=False, simulated=True, node=code)
    assert played.heard == ["first timer"]


@pytest.mark.parametrize(
    "linger",
    [pytest.param("", id="at once"), pytest.param("sum(range(3 * 10**7))", id="later", marks=pytest.mark.proof)],
)
def test_another_process_hears_only_what_is_kept_for_those_who_join_late(play, linger):
    speaker = """
    from rclpy.qos import DurabilityPolicy, QoSProfile
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    plain, late = node.create_publisher(String, "/plain", 10), node.create_publisher(String, "/kept", kept)
    said = node.create_publisher(String, "/said", kept)
    LINGER
    plain.publish(String(data="plain"))
    late.publish(String(data="kept"))
    said.publish(String(data="for the grader"))
    rclpy.spin(node)
    """.replace("LINGER", linger)
    ear = """
    from rclpy.qos import DurabilityPolicy, QoSProfile
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    said = node.create_publisher(String, "/said", 10)
    heard = []
    node.create_subscription(String, "/plain", lambda m: heard.append(m.data), 10)
    node.create_subscription(String, "/kept", lambda m: heard.append(m.data), kept)
    node.create_timer(0.2, lambda: said.publish(String(data=" ".join(heard))))
    rclpy.spin(node)
    """
    played = play(ticks=3, simulated=True, ear=ear, speaker=speaker)
    assert (played.heard, played.pace.paced_ticks) == (["kept"], 0)


@pytest.mark.proof
def test_who_joins_later_gets_first_what_was_kept_and_then_what_comes(play):
    kept = """
    from rclpy.qos import DurabilityPolicy, QoSProfile
    kept = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    """
    speaker = f"""{kept}
    publisher = node.create_publisher(Int32, "/numbers", kept)
    count = iter(range(100))
    node.create_timer(0.1, lambda: publisher.publish(Int32(data=next(count))))
    rclpy.spin(node)
    """
    ear = f"""{kept}
    said = node.create_publisher(String, "/said", 10)
    def join():
        timer.cancel()
        node.create_subscription(Int32, "/numbers", lambda m: said.publish(String(data=f"{{name}} {{m.data}}")), kept)
    timer = node.create_timer(AFTER, join)
    rclpy.spin(node)
    """
    files = {"early": ear.replace("AFTER", "0.05"), "late": ear.replace("AFTER", "0.45")}
    runs = [play(ticks=7, simulated=True, speaker=speaker, **files) for _ in range(2)]
    assert [run.pace.paced_ticks for run in runs] == [0, 0], runs[0].lines
    assert runs[0].heard == runs[1].heard
    heard = {name: [int(n) for who, n in map(str.split, runs[0].heard) if who == name] for name in files}
    assert heard["early"][:4] == [0, 1, 2, 3] and heard["late"][:3] == [2, 3, 4], runs[0].heard


@pytest.mark.proof
def test_who_keeps_less_than_the_publisher_gets_all_the_same(play):
    code = """
    from rclpy.qos import DurabilityPolicy, QoSProfile
    kept = [QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL) for depth in (50, 1)]
    """
    speaker = f"""{code}
    publisher = node.create_publisher(Int32, "/numbers", kept[0])
    for number in range(50): publisher.publish(Int32(data=number))
    rclpy.spin(node)
    """
    ear = f"""{code}
    said = node.create_publisher(String, "/said", 10)
    heard = []
    node.create_subscription(Int32, "/numbers", lambda m: heard.append(m.data), kept[1])
    node.create_timer(0.2, lambda: said.publish(String(data=" ".join(map(str, heard)))))
    rclpy.spin(node)
    """
    played = play(ticks=3, simulated=True, ear=ear, speaker=speaker)
    assert (played.heard, played.pace.paced_ticks) == ([" ".join(map(str, range(50)))], 0), played.lines


ONE_COMMAND_AT_THE_START = """
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node("teleop")
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
command = Twist()
command.linear.x = 0.5
sum(range({work}))
publisher.publish(command)
node.create_timer(2.0, lambda: publisher.publish(Twist()))
rclpy.spin(node)
"""
LATE_LISTENER = """
import time
from gz_course.grader.run.grader_endpoints import GraderEndpoints
begin = GraderEndpoints.__init__
def later(*arguments, **options):
    time.sleep({seconds})
    begin(*arguments, **options)
GraderEndpoints.__init__ = later
"""


@pytest.mark.proof
def test_one_score_and_one_truth_whoever_comes_late(tmp_path, grading):
    seen = set()
    for number in range(20):
        file = tmp_path / f"{number}" / "teleop_node.py"
        file.parent.mkdir()
        file.write_text(ONE_COMMAND_AT_THE_START.format(work=3 * 10**7 if number % 2 else 1))
        prelude = LATE_LISTENER.format(seconds=3.0 if number >= 10 else 0.0)
        report = grading(file.parent, "03_teleop", file, prelude=prelude).report
        seen.add((report["score"], report["truth_sha256"]))
        assert "published before anybody had found the publisher" in report["diagnosis"], report["diagnosis"]
    assert len(seen) == 1


def test_the_standard_library_is_as_the_patches_expect_it():
    assert misfits(THREADS) == []
