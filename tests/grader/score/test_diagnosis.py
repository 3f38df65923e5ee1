"""Each sentence of the diagnosis, from facts as a run writes them, and their order."""

import pytest

from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.score.crash import survived
from gz_course.grader.score.diagnosis import diagnose, outcome_of

LOOKS = find_kind("node").diagnosis().looks

TWIST, SCAN = "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan"
COUNT = {"topics/cmd_vel/count": [(0.1, 1.0)]}
BASE = {
    "ready": True,
    "exit_at": None,
    "exit_code": None,
    "endpoints": [],
    "listened": {"/cmd_vel": TWIST},
    "offered": {"/lidar/scan": SCAN, "/odom": "nav_msgs/msg/Odometry", "/clock": "rosgraph_msgs/msg/Clock"},
    "dropped": {},
}


def endpoint(topic="/cmd_vel", type=TWIST, kind="publisher", reliability="RELIABLE", durability="VOLATILE"):
    return {
        "node": "/teleop",
        "kind": kind,
        "topic": topic,
        "type": type,
        "reliability": reliability,
        "durability": durability,
    }


@pytest.fixture
def told(record):
    """Outcome and diagnosis for facts that differ from a good run's in what is given."""

    def call(*endpoints, signals=COUNT, lines=(), publisher=True, submission="node.py", **facts):
        ends = [endpoint(), *endpoints] if publisher else list(endpoints)
        told_lines = [(0.5, line) for line in lines]
        recording = record(signals, facts=BASE | {"endpoints": ends} | facts, lines=told_lines, submission=submission)
        return outcome_of(recording), diagnose(recording, LOOKS)

    return call


def test_a_good_run_has_none(told):
    scan = endpoint("/lidar/scan", SCAN, "subscription")
    assert told(scan) == ("graded", "")
    assert told(scan | {"reliability": "BEST_EFFORT"}) == ("graded", "")


def test_what_cannot_run(told):
    assert told(fault="node.py, line 3: SyntaxError: oh") == ("student_error", "node.py, line 3: SyntaxError: oh")


TRACE = [
    "Traceback (most recent call last):",
    '  File "/home/me/teleop_node.py", line 41, in <module>',
    "    main()",
    '  File "/home/me/teleop_node.py", line 24, in tick',
    "    speed = 1 / 0",
    "            ~~^~~",
    "ZeroDivisionError: division by zero",
]


def test_an_exception_with_its_place_in_the_students_file(told):
    assert told(exit_code=1, exit_at=1.25, lines=["[INFO] [t]: hi", *TRACE]) == (
        "student_error",
        "Your node died at 1.25 s of simulated time with ZeroDivisionError: division by zero "
        "(teleop_node.py, line 24: speed = 1 / 0). What that means: the divisor is 0 here: of a list that may be "
        "empty, len() is asked first; time that has passed may be 0 in the first call.",
    )


def test_an_error_whose_words_do_not_say_what_to_change_is_explained(told):
    error = "TypeError: Hello.say_hello() takes 0 positional arguments but 1 was given"
    _, sentence = told(lines=[*TRACE[:-1], error], exit_code=1, exit_at=1.5, submission="teleop_node.py")
    assert sentence.endswith(
        f"with {error} (teleop_node.py, line 24: speed = 1 / 0). What that means: a method gets the object itself as "
        "its first argument: def say_hello(self)."
    )


def test_an_error_after_which_the_node_went_on(record):
    said = survived(record({}, facts=BASE, lines=[(0.5, line) for line in TRACE], submission="teleop_node.py"))
    assert said.startswith(
        "An error was caught, and your node went on: ZeroDivisionError: division by zero (teleop_node"
    )
    ended = [*TRACE[:-1], "KeyboardInterrupt"]
    for facts, lines in ((BASE | {"exit_code": 1}, TRACE), (BASE, ended), (BASE, ["all is well"])):
        assert survived(record({}, facts=facts, lines=[(0.5, line) for line in lines], submission="a.py")) == ""


def test_the_last_of_several_tracebacks_counts(told):
    handled = ["Traceback (most recent call last):", '  File "/x/y.py", line 1, in f', "KeyError: 'handled'"]
    _, sentence = told(exit_code=1, exit_at=1.0, lines=[*handled, "going on", *TRACE])
    assert "ZeroDivisionError" in sentence and "KeyError" not in sentence


def test_the_place_is_in_the_students_file_not_in_the_library_it_called(told):
    deeper = [
        *TRACE[:5],
        '  File "/opt/ros/lib/rclpy/publisher.py", line 74, in publish',
        "    raise TypeError(text)",
        "TypeError: Expected Twist, got str",
    ]
    _, sentence = told(exit_code=1, exit_at=1.0, lines=deeper, submission="teleop_node.py")
    assert "TypeError: Expected Twist, got str" in sentence
    assert "teleop_node.py, line 24" in sentence


def test_what_is_said_after_the_traceback_is_not_taken_for_the_error(told):
    _, sentence = told(exit_code=1, exit_at=1.0, lines=[*TRACE, "[INFO] [teleop]: shutting down", "bye"])
    assert "ZeroDivisionError: division by zero" in sentence


def test_an_error_of_several_lines_begins_with_its_name(told):
    lines = [*TRACE[:-1], "RuntimeError: first line", "second line"]
    _, sentence = told(exit_code=1, exit_at=1.0, lines=lines)
    assert "RuntimeError: first line" in sentence


def test_an_exit_code(told):
    outcome, sentence = told(exit_code=7, exit_at=2.0)
    assert outcome == "student_error"
    assert "exit code 7 at 2.00 s" in sentence


@pytest.mark.parametrize(("code", "name"), [(-9, "SIGKILL"), (-11, "SIGSEGV"), (-6, "SIGABRT")])
def test_a_signal_is_named(told, code, name):
    outcome, sentence = told(exit_code=code, exit_at=2.0)
    assert outcome == "student_error"
    assert name in sentence and "2.00 s" in sentence


def test_a_process_that_ended_before_time_began(told):
    outcome, sentence = told(ready=False, exit_at=0.0, exit_code=0, publisher=False, signals={})
    assert outcome == "student_error"
    assert "before simulated time began" in sentence and "rclpy.spin()" in sentence


def test_a_process_that_never_spun(told):
    outcome, sentence = told(ready=False, publisher=False, signals={})
    assert outcome == "timeout"
    assert "never spun" in sentence and "rclpy.spin(node)" in sentence


def test_a_process_that_was_stopped_is_not_said_to_have_never_spun(told):
    outcome, sentence = told(ready=False, stopped=True, publisher=False, signals={})
    assert outcome == "timeout"
    assert "SIGSTOP" in sentence and "never spun" not in sentence


def test_nodes_that_never_come_to_rest(told):
    outcome, sentence = told(out_of_time=True, flooded=True, sim_seconds=1.25)
    assert outcome == "timeout"
    assert "more than 10000 messages at 1.25 s" in sentence and "answer each other" in sentence


def test_a_good_run_may_end_by_itself(told):
    assert told(exit_at=5.5, exit_code=0) == ("graded", "")


def publishers(told, *endpoints):
    outcome, sentence = told(*endpoints, publisher=False, signals={})
    assert outcome == "graded"
    return sentence


def test_no_publisher(told):
    assert publishers(told) == f"Your node has no publisher on /cmd_vel ({TWIST})."


def test_the_topics_every_node_has_are_not_taken_for_the_students(told):
    own = [endpoint("/rosout", "rcl_interfaces/msg/Log"), endpoint("/parameter_events", "x/msg/Y")]
    assert publishers(told, *own) == f"Your node has no publisher on /cmd_vel ({TWIST})."


@pytest.mark.parametrize(
    ("topic", "node", "why"),
    [
        ("/cmdvel", "/teleop", ""),
        ("/something/else", "/teleop", ""),
        ("/turtle1/cmd_vel", "/teleop", ""),
        ("/teleop/cmd_vel", "/teleop", " The ~ in its name stands for /teleop: leave it out."),
        ("/model/robot/cmd_vel", "/teleop", " On the ROS side it is called /cmd_vel: topics of ROS and of Gazebo may"),
        ("/robot1/cmd_vel", "/robot1/teleop", " Your node lives in the namespace /robot1, and a name that does not"),
        ("/robot1/teleop/cmd_vel", "/robot1/teleop", " The ~ in its name stands for /robot1/teleop"),
    ],
)
def test_a_publisher_on_another_topic(told, topic, node, why):
    sentence = publishers(told, endpoint(topic) | {"node": node})
    start = f"Nothing is published on /cmd_vel; your node publishes on {topic} instead."
    assert sentence.startswith(start + why)
    assert why or sentence == start


def test_a_publisher_of_another_type(told):
    sentence = publishers(told, endpoint(type="geometry_msgs/msg/TwistStamped"))
    assert sentence.startswith(f"/cmd_vel is published as geometry_msgs/msg/TwistStamped, but {TWIST} is expected")


def test_a_publisher_that_is_not_reliable(told):
    sentence = publishers(told, endpoint(reliability="BEST_EFFORT"))
    assert "BEST_EFFORT" in sentence and "RELIABLE" in sentence and "/cmd_vel" in sentence


def test_one_good_publisher_of_two_is_enough(told):
    assert told(endpoint(reliability="BEST_EFFORT"), endpoint(type="x/msg/Y")) == ("graded", "")


def test_a_subscription_to_nothing(told):
    _, sentence = told(endpoint("/lidar/scn", SCAN, "subscription"))
    assert sentence == "Your node subscribes to /lidar/scn, where nobody publishes; did you mean '/lidar/scan'?"
    _, sentence = told(endpoint("/q", SCAN, "subscription"))
    assert "did you mean '/lidar/scan'?" in sentence, "by its type"
    _, sentence = told(endpoint("/robot1/lidar/scan", SCAN, "subscription") | {"node": "/robot1/listener"})
    assert "did you mean '/lidar/scan'? Your node lives in the namespace /robot1" in sentence


def test_a_subscription_to_its_own_publisher_is_nobodys_fault(told):
    own = [endpoint("/drive", "std_msgs/msg/Bool", kind) for kind in ("publisher", "subscription")]
    assert told(*own) == ("graded", "")


def test_a_subscription_of_another_type(told):
    _, sentence = told(endpoint("/lidar/scan", "std_msgs/msg/Float32", "subscription"))
    assert sentence == f"Your node subscribes to /lidar/scan as std_msgs/msg/Float32, but it carries {SCAN}."


def test_a_subscription_that_asks_for_old_messages(told):
    _, sentence = told(endpoint("/lidar/scan", SCAN, "subscription", durability="TRANSIENT_LOCAL"))
    assert "TRANSIENT_LOCAL" in sentence and "/lidar/scan" in sentence and "VOLATILE" in sentence
    latched = endpoint("/lidar/scan", SCAN, "subscription", durability="TRANSIENT_LOCAL")
    assert told(latched, kept=["/lidar/scan"]) == ("graded", "")


def test_a_subscription_that_asks_for_more_than_best_effort(told):
    _, sentence = told(endpoint("/lidar/scan", SCAN, "subscription"), offered_best_effort=["/lidar/scan"])
    assert "/lidar/scan asks for the reliability RELIABLE, but the bridge offers BEST_EFFORT" in sentence
    relaxed = endpoint("/lidar/scan", SCAN, "subscription", reliability="BEST_EFFORT")
    assert told(relaxed, offered_best_effort=["/lidar/scan"]) == ("graded", "")


def test_a_publisher_that_never_published(told):
    _, sentence = told(signals={})
    assert sentence == "Your node has a publisher on /cmd_vel but never published a message."


def test_a_node_that_ended_before_it_published(told):
    _, sentence = told(signals={}, exit_at=0.02, exit_code=0)
    assert sentence.startswith("Your node's process ended (exit code 0) at 0.02 s of simulated time, before it had")
    assert "/cmd_vel" in sentence and "rclpy.spin(node)" in sentence


def test_commands_that_were_dropped(told):
    _, sentence = told(dropped={"/cmd_vel": 12})
    assert sentence.startswith("12 messages on /cmd_vel were dropped") and "NaN" in sentence


def test_one_dropped_message_is_one(told):
    _, sentence = told(dropped={"/cmd_vel": 1})
    assert sentence.startswith("1 message on /cmd_vel was dropped")


def test_a_simulation_that_broke(told):
    _, sentence = told(unstable="the robot flew apart at 1.2 s")
    assert "the robot flew apart at 1.2 s" in sentence


def test_the_first_cause_is_told_first(told):
    everything = {"dropped": {"/cmd_vel": 1}, "unstable": "x"}
    assert "NaN" in told(**everything)[1]
    assert "never published" in told(signals={}, **everything)[1]
    assert "subscribes" in told(endpoint("/q", SCAN, "subscription"), signals={}, **everything)[1]
    assert "no publisher" in told(publisher=False, signals={}, **everything)[1]
    assert "exit code 4" in told(publisher=False, signals={}, exit_code=4, exit_at=1.0, **everything)[1]
    assert told(publisher=False, signals={}, exit_code=4, exit_at=1.0, fault="f", **everything)[1] == "f"


def test_a_recording_without_facts_is_no_error(record):
    recording = record()
    assert outcome_of(recording) == "graded"
    assert diagnose(recording, LOOKS) == ""


def test_what_stands_before_a_publish_that_never_ran(told):
    here = {"file": "node.py", "line": 18, "code": "if self.n == 100:", "sends": 19}
    conditions = [here | {"topic": "/cmd_vel"}, here | {"line": 30, "code": "if x:", "topic": "/other"}]
    _, sentence = told(signals={}, conditions=conditions)
    assert sentence.endswith("What decides whether publish() on /cmd_vel is reached: line 18, `if self.n == 100:`.")
    assert told(conditions=conditions) == ("graded", "")


def test_an_error_that_is_caught_without_a_word_is_looked_for_where_nothing_is_published(told):
    place = {"file": "node.py", "line": 9, "first": 4, "last": 8}
    heard = endpoint("/lidar/scan", SCAN, "subscription")
    _, sentence = told(heard, signals={}, swallowed_errors=[place])
    assert "line 9 catches every error and shows none, so a mistake in lines 4 to 8 stays unseen" in sentence
    assert told(heard, swallowed_errors=[place]) == ("graded", "")


def test_a_message_that_is_kept_for_late_listeners_is_lost_to_those_that_do_not_ask_for_it(record):
    facts = BASE | {"too_early": {"/cmd_vel": 1}}
    for durability, words in (("TRANSIENT_LOCAL", "only for listeners that ask for it"), ("VOLATILE", "")):
        said = diagnose(record(facts=facts | {"endpoints": [endpoint(durability=durability)]}), LOOKS)
        assert "1 message on /cmd_vel was published before" in said
        assert words in said and bool(words) == ("TRANSIENT_LOCAL" in said)
