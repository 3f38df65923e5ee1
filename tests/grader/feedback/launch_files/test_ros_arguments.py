"""Parameters in a command without --ros-args, however the file puts the words of the command together."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

LAUNCH = """\
def follower(number, *more):
    names = ["-r", f"__ns:=/robot{number}"]
    parameters = ["-p", f"gap:={GAP}"]
    COMMAND
    return ExecuteProcess(cmd=command, output="screen")
"""


@pytest.mark.parametrize(
    ("command", "found"),
    [
        ('command = ["python3", "a.py", *names, *parameters]', True),
        ('command = ["python3", "a.py"] + names + parameters', True),
        ('command = ["python3", "a.py"]\n    command += names\n    command.extend(parameters)', True),
        ('command = ["python3", "a.py", "-p", "gap:=1.2"]', True),
        ('command = ["python3", "a.py", "--ros-args", *names, *parameters]', False),
        ('command = ["python3", "a.py"]\n    command.append("--ros-args")\n    command += parameters', False),
        ('command = ["python3", "a.py", *more, *parameters]', False),
        ('command = words("python3") + parameters', False),
        ('command = ["python3", "a.py", *names]', True),
        ('command = ["gz", "sim", "-r", "field.sdf"]', False),
    ],
)
def test_parameters_without_ros_args(command, found):
    slips = launch_places(LAUNCH.replace("COMMAND", command).encode())["launch_slips"]
    assert any("--ros-args is missing before" in each["said"] for each in slips) == found


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (
            'command = ["python3", "a.py", *parameters, "--ros-args", *names]',
            "-p f'gap:={GAP}' stands before --ros-args",
        ),
        (
            'command = ["python3", "a.py"] + names + ["--ros-args"] + parameters',
            "-r f'__ns:=/robot{number}' stands before",
        ),
        ('command = ["python3", "a.py", "--ros-args", *names, "--", "-p", "gap:=1.2"]', "stands behind the --"),
        (
            'return Node(package="a", executable="b", arguments=["-p", "gap:=1.2", "--ros-args", *names])',
            "-p gap:=1.2 stands before",
        ),
        (
            'return Node(package="a", executable="b", arguments=["-p", "gap:=1.2"])',
            "--ros-args is missing before -p gap:=1.2",
        ),
        ('return Node(package="a", executable="b", arguments=["--ros-args", "-p", "gap:=1.2"])', ""),
        ('command = ["python3", "a.py", "--ros-args", *names, *parameters, "--"]', ""),
    ],
)
def test_parameters_on_the_wrong_side_of_ros_args(command, words):
    slips = launch_places(LAUNCH.replace("COMMAND", command).encode())["launch_slips"]
    found = [each["said"] for each in slips if "--ros-args" in each["said"]]
    assert bool(found) == bool(words) and words in " ".join(found)


def test_a_parameter_that_the_program_does_not_declare():
    command = 'command = ["python3", "a.py", "--ros-args", *names, *parameters]'

    def said(node):
        slips = launch_places(LAUNCH.replace("COMMAND", command).encode(), {"a.py": node})["launch_slips"]
        return " ".join(each["said"] for each in slips)

    assert "a.py declares no parameter gap" in said(b"node.declare_parameter('distance', 1.2)")
    assert "declares no" not in said(b"node.declare_parameter('gap', 1.2)") + said(b"pass")


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ('"-p", "gap:=", LaunchConfiguration("gap")', True),
        ('"-p", "gap:=", "1.2"', True),
        ('"-p", ["gap:=", LaunchConfiguration("gap")]', False),
        ('"-p", "gap:=1.2"', False),
    ],
)
def test_a_value_that_is_a_word_of_its_own(words, found):
    launch = f'LaunchDescription([ExecuteProcess(cmd=["python3", "a.py", "--ros-args", {words}])])\n'
    slips = launch_places(launch.encode())["launch_slips"]
    assert any("'gap:=' and its value are two words" in each["said"] for each in slips) == found


@pytest.mark.parametrize(
    ("parameters", "found"),
    [
        ('[{"a": {"ros__parameters": {"use_sim_time": True}}}]', True),
        ('[{"ros__parameters": {"use_sim_time": True}}]', True),
        ('[{"use_sim_time": True, "pid": {"gain": 1.0}}]', False),
        ('["parameters.yaml"]', False),
    ],
)
def test_a_dict_with_the_levels_of_a_parameter_file(parameters, found):
    launch = f'LaunchDescription([Node(package="a", executable="b", parameters={parameters})])\n'
    slips = launch_places(launch.encode())["launch_slips"]
    assert any("belong into a parameter file" in each["said"] for each in slips) == found


@pytest.mark.parametrize(("value", "found"), [('"True"', True), ('"yes"', True), ("True", False), ("TIME", False)])
def test_a_truth_in_quotes(value, found):
    launch = f'LaunchDescription([Node(executable="b", parameters=[{{"use_sim_time": {value}}}])])\n'
    slips = launch_places(launch.encode())["launch_slips"]
    assert any("and takes True or False, without quotes" in each["said"] for each in slips) == found


@pytest.mark.parametrize(
    ("word", "shell", "found"),
    [
        ("use_sim_time:='true'", "", True),
        ("use_sim_time:=true", "", False),
        ("use_sim_time:='true'", ", shell=True", False),
        ("name:='robot'", "", False),
    ],
)
def test_quotes_that_no_shell_takes_away(word, shell, found):
    file = (
        f'run = ExecuteProcess(cmd=["python3", "a.py", "--ros-args", "-p", "{word}"]{shell})\nLaunchDescription([run])'
    )
    slips = launch_places(file.encode())["launch_slips"]
    assert any("write use_sim_time:=true" in each["said"] for each in slips) == found


@pytest.mark.parametrize(
    ("owner", "found"), [("follower", True), ("/follower", True), ("/**", False), ("/robot2/follower", False)]
)
def test_a_parameter_file_for_a_node_without_its_namespace(owner, found):
    command = 'command = ["python3", "a.py", "--ros-args", *names, "--params-file", str(HERE / "a.yaml")]'
    content = f"# of all\n{owner}:\n  ros__parameters:\n    gap: 1.2\n".encode()
    slips = launch_places(LAUNCH.replace("COMMAND", command).encode(), {"a.yaml": content})["launch_slips"]
    assert any("holds parameters of the node /follower" in each["said"] for each in slips) == found


def test_simulated_time_for_a_command_whose_words_are_put_together():
    command = 'command = ["python3", "a.py", "--ros-args", *names, *parameters]'
    launch = (
        LAUNCH.replace("COMMAND", command) + "LaunchDescription([SetParameter('use_sim_time', True), follower(2)])\n"
    )

    def said(source):
        return " ".join(each["said"] for each in launch_places(source.encode())["launch_slips"])

    assert "SetParameter reaches only the Node actions" in said(launch)
    assert "SetParameter reaches only" not in said(launch.replace('["-p", f"gap', '["-p", "use_sim_time:=true", f"gap'))
    assert "SetParameter reaches only" not in said(launch.replace("*names, ", "*names, *more, "))
    assert "SetParameter reaches only" not in said(launch.replace("*names, ", "'--params-file', 'a.yaml', *names, "))
