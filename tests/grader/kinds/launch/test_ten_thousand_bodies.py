"""A robot file of 10,000 bodies: however far the run comes with it, the answer is one sentence about its size."""

import hashlib
import re
from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.record.reading import Recording
from gz_course.grader.run.session import run
from gz_course.grader.score.score import score
from gz_course.grader.submission import Submission

ROOT = Path(__file__).parents[4]
BODY = (
    "<link name='b{0}'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    "<collision><geometry><sphere radius='0.01'/></geometry></collision></link><joint name='j{0}' type='continuous'>"
    "<parent link='base'/><child link='b{0}'/><origin xyz='{0} 0 0'/></joint>"
)
BASE = BODY.partition("<joint")[0].format("ase")  # its name is "base"
XACRO = """<robot name="scout" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="row" params="i n"><xacro:if value="${n > 0}">BODY<xacro:row i="${i + 1}" n="${n - 1}"/></xacro:if>
</xacro:macro>
<xacro:macro name="rows" params="i n"><xacro:if value="${n > 0}">
<xacro:row i="${i}" n="100"/><xacro:rows i="${i + 100}" n="${n - 1}"/></xacro:if></xacro:macro>
BASE
<xacro:rows i="0" n="100"/></robot>""".replace("BODY", BODY.format("${i}")).replace("BASE", BASE)
LAUNCH = """
from pathlib import Path
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
HERE = Path(__file__).parent
def generate_launch_description():
    text = DESCRIPTION
    parameters = [{"robot_description": ParameterValue(text, value_type=str), "use_sim_time": True}]
    rsp = "robot_state_publisher"
    return LaunchDescription([
        ExecuteProcess(cmd=["gz", "sim", "-s", "-r", str(HERE / "yard.sdf")], output="screen"),
        Node(package=rsp, executable=rsp, parameters=parameters),
        Node(package="ros_gz_sim", executable="create", arguments=["-topic", "/robot_description", "-name", "scout"]),
    ])
"""
IN_PYTHON = f'''"<robot name='scout'>{BASE}" + "".join("{BODY}".format(i) for i in range(10000)) + "</robot>"'''
# A slow machine gives up where xacro, or create, is still at work; a fast one comes to the simulator, which refuses.
SENTENCES = (
    r"a Command in it \(such as xacro\), or its own Python, takes far too long",
    r"the robot has 10000 joints, far too many",
    r"has 10000 links with collisions, more than 2000",
    r"a description of \d+ MiB is too large",
    r"the run was ended",
)


@pytest.mark.proof
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("description", ['Command(["xacro ", str(HERE / "robot.urdf.xacro")])', IN_PYTHON])
def test_ten_thousand_bodies_are_answered_in_one_sentence(tmp_path, description):
    exercise = find_exercise("06_spawn", ROOT)
    text = LAUNCH.replace("DESCRIPTION", description).encode()
    files = {"bringup.launch.py": text, "robot.urdf.xacro": XACRO.encode()}
    submission = Submission(tmp_path, "bringup.launch.py", hashlib.sha256(text).hexdigest(), None, files)
    made = run(exercise, submission, Trial("made", 0), "lockstep", tmp_path / "run.rrd", "D")
    with made.recorder:
        pass
    result = score(Recording(tmp_path / "run.rrd"), exercise)
    assert result.points <= 15, "no robot came"
    assert any(re.search(sentence, result.diagnosis, re.IGNORECASE) for sentence in SENTENCES), result.diagnosis
    assert "\n" not in result.diagnosis and "Traceback" not in result.diagnosis and len(result.diagnosis) < 1200
