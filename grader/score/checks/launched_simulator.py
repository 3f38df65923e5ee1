"""`launched_simulator`: does the launch start exactly one simulator, which runs to the end?

kind = "launched_simulator"
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import (
    by_python,
    complaint,
    kept_back,
    launch_facts,
    ran,
    several_simulators,
    simulator_fault,
    started,
)


@check_kind("launched_simulator")
def launched_simulator(recording: Recording, parameters: Table) -> Finding:
    """Pass if an action started the only `gz sim`, and it was still running when the launch was interrupted."""
    expected = "one gz sim with a world, from the start to the end"
    facts, running = launch_facts(recording), ran(recording)
    if not running:
        error = next((each["error"] for each in facts.get("simulators", []) if each["error"]), "")
        said = error or complaint(recording, "gz sim")
        if not said and "a simulator" in facts.get("refused", []):
            return Finding(False, expected, "a process that is not gz sim claimed to be gz sim; nothing was simulated")
        if not said and facts.get("running") and not started(recording):
            measured = "the launch took so long before it started anything that it was ended"
            why = "a Command in it (such as xacro), or its own Python, takes far too long or never ends"
            return Finding(False, expected, measured, explanation=why)
        measured = f"gz sim said: {said}" if said else "no simulator was started"
        why = simulator_fault(said, recording) if said else kept_back(recording, "simulators_made")
        return Finding(False, expected, measured, explanation=why)
    if len(running) > 1:
        worlds = ", ".join(each["world"] for each in running)
        measured = f"{len(running)} simulators were started ({worlds}); each publishes its own time"
        return Finding(False, expected, measured, explanation=several_simulators(recording))
    if measured := by_python(recording, "gz"):
        return Finding(False, expected, measured)
    if not facts["simulator_at_end"]:
        return Finding(False, expected, "gz sim had ended before the launch was interrupted")
    return Finding(True, expected, f"it ran {running[0]['world']}")
