"""`launched_simulator`, `_world`, `_paused`, `_node`, `_end`: both verdicts, and what is said about a launch."""

import json

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.score.check import check_kinds
from gz_course.grader.score.diagnosis import diagnose, outcome_of
from gz_course.grader.score.launched import (
    deaths,
    kept_back,
    launch_fault,
    launch_slips,
    looked_elsewhere,
    not_started,
    several_simulators,
    simulator_fault,
)

LOOKS = find_kind("launch").diagnosis().looks
SIMULATOR = {"given": "a.sdf", "world": "a.sdf", "error": "", "paused": False, "iterations": 0, "ran": True}
GOOD = {
    "simulators": [SIMULATOR],
    "simulator_at_end": "a.sdf",
    "running": True,
    "ended_early": [],
    "exit_code": 0,
    "ended_itself": True,
    "escalated": [],
    "left": [],
    "error": "",
}
PARAMETERS = {
    "simulator": {},
    "world": {"argument": "world", "default": "a.sdf"},
    "paused": {"argument": "paused", "default": False},
    "node": {"node": "/stopwatch", "program": "stopwatch.py"},
    "end": {},
}
STARTED = "[INFO] [crier-1]: process started with pid [...]"
CLOCKED = [{"node": "/stopwatch", "topic": topic} for topic in ("/clock", "/stopwatch")]


@pytest.fixture
def find(record):
    """What a kind finds in a run that was good but for `changes`, called with some launch arguments."""

    def call(kind, arguments=None, endpoints=CLOCKED, lines=(), seconds=2.0, **changes):
        trial = json.dumps({"poses": {}, "parameters": arguments or {}})
        facts = {"launch": GOOD | changes, "endpoints": endpoints, "sim_seconds": seconds}
        recording = record(facts=facts, lines=[(0.0, line) for line in lines], trial_parameters=trial)
        return check_kinds()[f"launched_{kind}"](recording, Table(PARAMETERS[kind], "check 'it'", "parameter"))

    return call


@pytest.mark.parametrize("kind", PARAMETERS)
def test_a_good_launch_passes(find, kind):
    assert find(kind).passed


@pytest.mark.parametrize(
    ("changes", "measured"),
    [
        ({"simulators": [], "lines": [STARTED]}, "no simulator was started"),
        (
            {"simulators": []},
            "the launch took so long before it started anything that it was ended",
        ),
        ({"simulators": [SIMULATOR | {"ran": False, "error": "no such world"}]}, "gz sim said: no such world"),
        (
            {"simulators": [SIMULATOR, SIMULATOR]},
            "2 simulators were started (a.sdf, a.sdf); each publishes its own time",
        ),
        ({"simulator_at_end": ""}, "gz sim had ended before the launch was interrupted"),
        ({"simulators": [], "lines": ["[gz-1] gz sim: which world? Name one"]}, "gz sim said: which world? Name one"),
    ],
)
def test_no_simulator_or_too_many(find, changes, measured):
    finding = find("simulator", **changes)
    assert (finding.passed, finding.measured) == (False, measured)


@pytest.mark.parametrize(
    ("conditions", "words"),
    [
        (
            ["If(p)", ""],
            "b.py, line 2: this simulator has no condition, so it starts in any case, beside that of line 1",
        ),
        (["", ""], "b.py, line 2: a second simulator is started here"),
        (["If(p)", "If(p)"], "b.py, line 2: this simulator has the same condition"),
        (["If(p)", "Unless(p)"], ""),
        (["If(p)"], ""),
    ],
)
def test_the_simulator_that_nothing_keeps_back_is_named(record, conditions, words):
    made = [{"file": "b.py", "line": i, "condition": each} for i, each in enumerate(conditions, 1)]
    said = several_simulators(record(facts={"simulators_made": made}))
    assert said.startswith(words) and bool(said) == bool(words)


@pytest.mark.parametrize(("arguments", "passed"), [({}, True), ({"world": "a.sdf"}, True), ({"world": "b.sdf"}, False)])
def test_the_world_is_that_of_the_argument_or_the_default(find, arguments, passed):
    finding = find("world", arguments)
    assert finding.passed is passed
    if not passed:
        assert finding.measured == "called with world:=b.sdf it ran a.sdf"
    assert not find("world", arguments, simulators=[]).passed


@pytest.mark.parametrize("paused", [False, True])
@pytest.mark.parametrize("given", ["true", "True", "1", "false", "", None])
def test_paused_exactly_when_asked(find, given, paused):
    arguments = {} if given is None else {"paused": given}
    finding = find("paused", arguments, seconds=0.0 if paused else 2.0, simulators=[SIMULATOR | {"paused": paused}])
    assert finding.passed == (paused == (given in ("true", "True", "1")))
    assert ("had no -r" if paused else "had -r") in finding.measured


@pytest.mark.parametrize("seconds", [0.0, 2.0])
def test_it_is_the_time_that_passed_which_counts_not_the_command_line(find, seconds):
    finding = find("paused", {"paused": "true"}, seconds=seconds, simulators=[SIMULATOR | {"paused": bool(seconds)}])
    assert finding.passed == (not seconds)
    assert finding.measured == f"called with paused:=true it {'ran' if seconds else 'was paused'}"


def test_what_no_action_has_started_does_not_count(find):
    by_python = ["gz", "stopwatch.py"]
    measured = "was started by Python (subprocess or os.system), not by an action of the launch"
    assert find("simulator", by_python=by_python).measured == f"gz {measured}"
    assert find("node", by_python=by_python).measured == f"stopwatch.py {measured}"
    assert not find("simulator", by_python=by_python).passed and not find("node", by_python=by_python).passed


@pytest.mark.parametrize(
    ("changes", "measured"),
    [
        ({"endpoints": []}, "the node /stopwatch never ran"),
        ({"endpoints": [{"node": "/stop_watch", "topic": "/clock"}]}, "the node /stopwatch never ran; /stop_watch did"),
        ({"endpoints": CLOCKED[1:]}, "/stopwatch ran without use_sim_time: it does not follow /clock"),
        (
            {"ended_early": [{"program": "stopwatch.py", "code": 1}]},
            "stopwatch.py had ended with exit code 1 before the launch was interrupted",
        ),
    ],
)
def test_a_node_that_is_not_there_or_keeps_another_time(find, changes, measured):
    finding = find("node", **changes)
    assert (finding.passed, finding.measured) == (False, measured)


DIED = [
    "[INFO] [gz-1]: process started with pid [...]",
    "[parameter_bridge-2] parameter_bridge: bridge.yaml: cannot read the bridge configuration: No such file",
    "[python3-3] python3: can't open file '/tmp/stopwatch.py'",
    "[ERROR] [python3-3]: process has died [pid [...], exit code 2].",
    "[ERROR] [parameter_bridge-2]: process has died [pid [...], exit code 2].",
    "[ERROR] [gz-1]: process has died [pid [...], exit code -2].",
]


def test_what_a_process_said_last_before_it_died_is_quoted(find, record):
    finding = find("node", lines=DIED, ended_early=[{"program": "stopwatch.py", "code": 2}])
    assert finding.measured.endswith("interrupted; it said: python3: can't open file '/tmp/stopwatch.py'")
    recording = record(facts={"launch": GOOD}, lines=[(0.0, line) for line in DIED])
    assert [(each.process, each.code) for each in deaths(recording)] == [("python3", 2), ("parameter_bridge", 2)]
    wanted = {"ros_topic": "/clock", "ros_type": "r", "gz_topic": "/clock", "gz_type": "g", "direction": "GZ_TO_ROS"}
    bridge = check_kinds()["bridged"](recording, Table(wanted | {"at_least": 5}, "check 'it'", "parameter"))
    assert bridge.measured == (
        "parameter_bridge ended with exit code 2; it said: parameter_bridge: bridge.yaml: cannot read the bridge "
        "configuration: No such file"
    )


TRACEBACK = [
    "[python3-3] Traceback (most recent call last):",
    '[python3-3]   File "/submission/ranger_node.py", line 22, in __init__',
    '[python3-3]     super().__init("ranger")',
    '[python3-3]   File "/opt/lib/python3.11/site-packages/rclpy/node.py", line 88, in declare',
    "[python3-3] TypeError: spin() missing 1 required positional argument: 'node'",
    "[ERROR] [python3-3]: process has died [pid [...], exit code 1].",
]


def test_an_error_of_a_node_has_its_place_and_its_meaning(find, record):
    recording = record(facts={"launch": GOOD}, lines=[(0.0, line) for line in TRACEBACK])
    (death,) = deaths(recording)
    assert death.words == (
        "; it said: TypeError: spin() missing 1 required positional argument: 'node' "
        '(ranger_node.py, line 22: super().__init("ranger"))'
    )
    assert death.why.startswith('ranger_node.py, line 22: super().__init("ranger"): the call is rclpy.spin(node)')
    finding = find("node", lines=TRACEBACK, endpoints=[])
    assert finding.measured.startswith("the node /stopwatch never ran: python3 ended with exit code 1; it said: Type")
    assert finding.explanation == death.why


@pytest.mark.parametrize(
    ("said", "words"),
    [
        (
            "bringup.launch.py/bridge.yaml: cannot read the bridge configuration: Not a directory",
            "bringup.launch.py is the launch file itself, not a folder",
        ),
        ("bridge.yaml: cannot read: No such file or directory", "bridge.yaml was looked for in the folder"),
        ("/bridge.yaml: cannot read: No such file or directory", "bridge.yaml was looked for in the folder /, where"),
        ("can't open file '/a/b/watch.py': [Errno 2] No such file or directory", "in the folder /a/b/, where it does"),
        ("no bridge", ""),
    ],
)
def test_a_path_that_leads_elsewhere_is_explained(said, words):
    assert words in looked_elsewhere(said) and bool(words) == bool(looked_elsewhere(said))


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("argument -s: ignored explicit argument 'lidar_room.sdf'", "a space is missing between -s and lidar_room.sdf"),
        ("argument -s: ignored explicit argument ' -r'", "-s -r is one word"),
        ("world file '<launch.LaunchConfiguration object at 0x7f>' was not found", "a Python object stands in"),
        ("world file 'world' was not found as a path", "LaunchConfiguration('world')"),
        ("world file '/submission/b.sdf' was not found as a path", "looked for in the folder /submission"),
        ("world file 'c.sdf' was not found as a path", ""),
        ("which world?", ""),
    ],
)
def test_a_command_line_of_the_simulator_is_explained(record, said, words):
    facts = {"declared": [{"file": "a.py", "line": 1, "name": "world"}]}
    recording = record(facts=facts, trial_parameters=json.dumps({"parameters": {"world": "b.sdf"}}))
    found = simulator_fault(said, recording)
    assert words in found and bool(words) == bool(found)


def test_arguments_of_other_names_and_worlds_that_stand_in_the_command_are_named(record):
    place = {"file": "a.launch.py", "line": 7}
    trial = json.dumps({"parameters": {"world": "b.sdf"}})
    for facts, words in (
        ({"declared": [place | {"name": "file"}, place | {"name": "paused"}]}, "no argument called world; it declares"),
        ({"fixed_worlds": [place | {"world": "a.sdf"}]}, "a.launch.py, line 7: a.sdf is written into the command"),
        ({"fixed_worlds": [place | {"world": "c.sdf"}], "declared": [place | {"name": "world"}]}, ""),
    ):
        recording = record(facts={"launch": GOOD} | facts, trial_parameters=trial)
        finding = check_kinds()["launched_world"](recording, Table(PARAMETERS["world"], "check 'it'", "parameter"))
        assert not finding.passed and words in finding.explanation and bool(words) == bool(finding.explanation)


@pytest.mark.parametrize(
    ("default", "given", "words"),
    [
        ("true", {}, "a.launch.py, line 7: the default_value of paused is 'true', not 'false'"),
        ("true", {"paused": "false"}, ""),
        ("False", {}, ""),
    ],
)
def test_a_default_that_is_not_asked_for_is_named(record, default, given, words):
    facts = {"declared": [{"file": "a.launch.py", "line": 7, "name": "paused", "default": default}], "launch": GOOD}
    recording = record(facts=facts | {"sim_seconds": 0.0}, trial_parameters=json.dumps({"parameters": given}))
    finding = check_kinds()["launched_paused"](recording, Table(PARAMETERS["paused"], "check 'it'", "parameter"))
    assert (finding.passed, finding.explanation) == (False, words)


def test_programs_that_did_not_start_and_mistakes_in_the_file_come_first(record):
    line = "[ERROR] [gz sim -s -1]: /submission/bringup.launch.py:22: there is no program 'gz sim -s ' to be started"
    slip = {"file": "bringup.launch.py", "line": 7, "said": "this is wrong"}
    recording = record(facts={"launch": GOOD, "launch_slips": [slip]}, lines=[(0.0, STARTED), (0.0, line)])
    assert not_started(recording) == (
        "bringup.launch.py, line 22: there is no program 'gz sim -s ' to be started. What that means: the whole "
        "command line is one word of the list: cmd takes each word by itself, ['gz', 'sim', ...]."
    )
    assert launch_slips(recording) == "bringup.launch.py, line 7: this is wrong."
    assert not_started(record()) == launch_slips(record()) == ""


def test_what_a_bridge_has_left_out_is_quoted(record):
    said = "bridge.yaml:4: rosgraph_msgs/msg/Clock cannot become gz.msgs.Clok"
    line = f"[parameter_bridge-2] [ERROR] [1700000000.123456789] [ros_gz_bridge]: {said}"
    recording = record(facts={"launch": GOOD}, lines=[(0.0, "[gz-1] [ERROR] [gz]: no"), (0.0, line)])
    wanted = {"ros_topic": "/time", "ros_type": "r", "gz_topic": "/clock", "gz_type": "g", "direction": "GZ_TO_ROS"}
    bridge = check_kinds()["bridged"](recording, Table(wanted | {"at_least": 5}, "check 'it'", "parameter"))
    assert bridge.measured == f"no bridge has the ROS topic /time; parameter_bridge said: {said}"


@pytest.mark.parametrize(
    ("changes", "measured"),
    [
        ({"running": False}, "the launch had ended before it was interrupted"),
        ({"left": ["a.sdf"]}, "the launch ended, but this ran on: a.sdf"),
        ({"ended_itself": False}, "the launch did not end"),
        ({"escalated": ["gz-1"]}, "gz-1 did not listen to Ctrl-C for 5 s"),
        ({"exit_code": 1}, "the launch ended with exit code 1"),
    ],
)
def test_an_end_that_is_none(find, changes, measured):
    finding = find("end", **changes)
    assert (finding.passed, finding.measured) == (False, measured)


def test_a_program_of_python_that_runs_on(find):
    finding = find("end", left=["a.py"], by_python=["a.py"])
    assert finding.explanation == "a.py was started by Python (subprocess or os.system), not by an action of the launch"


def test_the_fault_of_a_launch_comes_with_file_and_line(record):
    error = "/submission/bringup.launch.py:26: NameError: name 'x' is not defined"
    facts = {"launch": GOOD | {"error": error, "exit_code": 1, "running": False}, "exit_code": 1, "exit_at": 0.0}
    recording = record(facts=facts)
    sentence = "The launch failed: bringup.launch.py, line 26: NameError: name 'x' is not defined"
    assert launch_fault(recording) == diagnose(recording, LOOKS) == sentence
    assert outcome_of(recording) == "student_error"
    of_xml = {"error": "/submission/bringup.launch.xml:2:3: there is no action <nod>", "exit_code": 1, "running": False}
    facts = {"launch": GOOD | of_xml, "exit_code": 1, "exit_at": 0.0}
    said = launch_fault(record(facts=facts))
    assert said == "The launch failed: bringup.launch.xml, line 2, column 3: there is no action <nod>"


def test_a_launch_without_fault_has_none(record):
    assert launch_fault(record(facts={"launch": GOOD})) == diagnose(record(facts={"launch": GOOD}), LOOKS) == ""
    assert launch_fault(record()) == ""


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "b.py, line 9: the command of stopwatch.py does not hold use_sim_time; line 5 gives it to bridge"),
        ({"elsewhere": 0, "executable": ""}, "b.py, line 9: the command of stopwatch.py does not hold use_sim_time"),
        ({"sim_time": True}, ""),
        ({"program": "other.py"}, ""),
    ],
)
def test_the_command_without_simulated_time_is_named(record, changes, words):
    place = {"file": "b.py", "line": 9, "program": "stopwatch.py", "sim_time": False}
    place |= {"elsewhere": 5, "executable": "bridge"}
    facts = {"launch": GOOD, "endpoints": CLOCKED[1:], "programs": [place | changes]}
    kind = check_kinds()["launched_node"]
    assert kind(record(facts=facts), Table(PARAMETERS["node"], "check 'it'", "parameter")).explanation == words


def test_a_default_world_without_a_folder(record):
    said = "world file '{}' was not found as a path"
    recording = record(facts={"declared": [{"file": "a.py", "line": 1, "name": "world", "default": "yard.sdf"}]})
    assert "str(Path(__file__).parent / 'yard.sdf')" in simulator_fault(said.format("yard.sdf"), recording)
    assert simulator_fault(said.format("empty.sdf"), recording) == ""


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("{world}", "'{world}' is a text, with its braces"),
        ("$(var world)", "Python writes LaunchConfiguration('world')"),
        ("$(arg world)", "XML and YAML write it so"),
    ],
)
def test_a_world_that_is_a_pattern(record, given, words):
    assert words in simulator_fault(f"world file '{given}' was not found as a path", record())


@pytest.mark.parametrize(
    ("conditions", "words"),
    [
        (["If(p)"], "b.py, line 1: this starts only with condition=If(p); nothing else starts one"),
        (["If(p)", "If(q)"], "and that of line 2 only with condition=If(q)"),
        (["If(p)", ""], ""),
        ([], ""),
    ],
)
def test_the_condition_that_keeps_everything_back_is_named(record, conditions, words):
    made = [{"file": "b.py", "line": i, "condition": each} for i, each in enumerate(conditions, 1)]
    said = kept_back(record(facts={"bridges_made": made}), "bridges_made")
    assert words in said and bool(said) == bool(words)
