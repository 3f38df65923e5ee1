"""Processes that are in no graph: in another ROS domain, or ended at their start."""

import signal
import subprocess
import sys
import time

from rclpy.logging import get_logging_directory

from gz_course.grader.run.domain import Domain
from gz_course.grader.tools.diagnose.distant import distant_processes, domains_of
from gz_course.grader.tools.diagnose.ended import ended_programs
from gz_course.grader.tools.diagnose.finding import findings
from gz_course.grader.tools.diagnose.system import GzSide, RosSide, System
from gz_course.sim.bridge.ros_gz_bridge import parameter_bridge
from gz_course.sim.gz.transport.environment import default_partition
from gz_course.sim.ros.ros_program.last_words import LastWords, leave

# The ports of a participant, and nothing else of it.
PARTICIPANT = """
import socket, sys
ends = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
for number, end in enumerate(ends):
    end.bind(("127.0.0.1", 7400 + 250 * int(sys.argv[1]) + 238 + number))
print("ready", flush=True)
sys.stdin.read()
"""


def told(system, kind):
    return [finding for finding in findings(system) if finding.kind == kind]


def test_a_listener_in_another_domain_is_told(domain):
    with Domain() as other:
        command = [sys.executable, "-I", "-c", PARTICIPANT, str(other.id)]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        with process:
            assert process.stdout.readline() == "ready\n"
            distant = distant_processes(domain, default_partition())
            assert distant_processes(other.id, default_partition()) == []
            assert distant_processes(domain, "another partition") == []
            process.stdin.close()
    assert [(each.pid, each.domain) for each in distant] == [(process.pid, other.id)]
    (finding,) = told(System(RosSide(domain=domain), GzSide(), distant=distant), "other_domain")
    where = f"The process {process.pid} is in ROS domain {other.id}, this terminal is in {domain}:"
    assert finding.sentence.startswith(where)
    assert f"export ROS_DOMAIN_ID={domain}" in finding.fix
    assert finding.evidence[0].startswith(f"{process.pid}: ")


def test_a_domain_is_known_by_a_pair_of_ports():
    assert domains_of({7410, 7411}) == {0}
    assert domains_of({7400 + 250 * 232 + 12, 7400 + 250 * 232 + 13, 7400 + 250 * 232}) == {232}
    assert domains_of({7400, 7401, 7411, 7412, 65500, 80, 7398, 7399}) == set(), "multicast, odd, alone, too low"


def test_a_bridge_that_died_of_its_own_file_is_told(domain, tmp_path, capsys):
    file = tmp_path / "bridge.yaml"
    file.write_text("- ros_topic_name: [\n")
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        assert parameter_bridge.main(["--strict", "--ros-args", "-p", f"config_file:={file}"]) == 2
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
    sentence = capsys.readouterr().err.splitlines()[-1].removeprefix("parameter_bridge: ")
    place = (domain, default_partition())
    (finding,) = told(System(RosSide(), GzSide(), ended=ended_programs(*place)), "ended_program")
    assert finding.sentence == f"parameter_bridge was started just now and ended at once: {sentence.rstrip('.')}."
    assert str(file) in finding.sentence and "lint FILE" in finding.fix
    assert ended_programs(domain + 1, place[1]) == ended_programs(domain, "another") == []
    leave(get_logging_directory(), LastWords("tf2_echo", 1, time.time(), *place, ("not a part of the system",)))
    assert len(ended_programs(*place)) == 1
