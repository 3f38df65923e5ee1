"""`launched_node`: does the launch start a node, and does it follow simulated time?

kind = "launched_node"
node = "/stopwatch"
program = "stopwatch.py"      # what it is started from
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import by_python, deaths, launch_facts, without_sim_time
from gz_course.sim.did_you_mean import nearest_name

_OTHERS = ("gz", "parameter_bridge", "create")  # processes that are not nodes of the student's


@check_kind("launched_node")
def launched_node(recording: Recording, parameters: Table) -> Finding:
    """Pass if the node existed to the end and subscribed to /clock, as it does with use_sim_time."""
    node, program = parameters.text("node"), parameters.text("program")
    expected = f"the node {node} with use_sim_time, to the end"
    endpoints = recording.facts().get("endpoints", [])
    nodes = {each["node"] for each in endpoints}
    ended = [each for each in launch_facts(recording).get("ended_early", []) if each["program"] == program]
    if ended:
        code = ended[0]["code"]
        died = [each for each in deaths(recording) if each.code == code and not each.process.startswith(_OTHERS)]
        said, why = (died[0].words, died[0].why) if len(died) == 1 else ("", "")
        measured = f"{program} had ended with exit code {code} before the launch was interrupted{said}"
        return Finding(False, expected, measured, explanation=why)
    if node not in nodes:
        near = nearest_name(node, nodes)
        other = next((each for each in deaths(recording) if not each.process.startswith(_OTHERS)), None)
        if other is not None:
            measured = f"the node {node} never ran: {other.process} ended with exit code {other.code}{other.words}"
            return Finding(False, expected, measured, explanation=other.why)
        return Finding(False, expected, f"the node {node} never ran" + (f"; {near} did" if near else ""))
    if measured := by_python(recording, program):
        return Finding(False, expected, measured)
    if node not in recording.facts().get("nodes", [node]):
        return Finding(False, expected, f"{node} was no longer in the ROS graph when the launch was interrupted")
    if not any(each["node"] == node and each["topic"] == "/clock" for each in endpoints):
        measured = f"{node} ran without use_sim_time: it does not follow /clock"
        return Finding(False, expected, measured, explanation=without_sim_time(recording, program))
    return Finding(True, expected, "so it was")
