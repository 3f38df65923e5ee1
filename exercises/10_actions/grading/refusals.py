"""Which goals a server accepts that it must reject, and what it does with them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .patrol_run import Run

GOALS = {
    "empty": ("a goal without waypoints", "accepts_empty"),
    "too_fast": ("a speed above max_speed", "other_limit"),
    "backwards": ("a negative speed", "accepts_backwards"),
    "standing": ("a speed of 0", "accepts_standing"),
}
MAX_SPEED = 0.5  # [m/s] if nobody sets the parameter


def accepted(run: Run) -> str:
    """Return a sentence on the goals that a server accepts and must not, and where its file lets them through."""
    names = [goal for goal in GOALS if run.one("accepted", goal)]
    if not names:
        return ""
    words = [GOALS[goal][0] for goal in names]
    if len(names) == len(GOALS):
        what = "Your server accepts every goal, also those that cannot be done"
    else:
        what = f"Your server accepts {' and '.join(words)}"
    if names == ["too_fast"]:
        what = f"Your server accepts {run.one('sent', 'too_fast')['speed']:g} m/s where max_speed is {limit(run):g}"
    if said := suspect(run.recording, "accepts_all", *(GOALS[goal][1] for goal in names)):
        what += f": {said}"
    ends = {(run.one("result", goal) or {}).get("status") for goal in names}
    if ends == {"ABORTED"}:
        what += (
            f"{'. It' if said else ', and'} ends {'it' if len(names) == 1 else 'them'} as ABORTED, which is too late: "
            "a goal is rejected in goal_callback, by GoalResponse.REJECT"
        )
    return what


def limit(run: Run) -> float:
    """Return max_speed [m/s] in the trial of a run."""
    trial = json.loads(run.recording.properties("run").get("trial_parameters", "{}"))
    return float(trial.get("parameters", {}).get("server", {}).get("max_speed", MAX_SPEED))
