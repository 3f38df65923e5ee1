"""What helps with a failed check, in a notebook: buttons for `course hint` and `course explain`, or the commands.

The buttons run the commands themselves, so a hint that the instructor holds back stays back.
"""

from __future__ import annotations

import html
import subprocess
import sys
from pathlib import Path
from typing import Any

from gz_course.grader.lessons.in_notebook import InNotebook

_DEADLINE_S = 900.0
"""Wall time [s] of a command; `course explain` computes for a minute, longer on a busy machine."""
COMMAND = (sys.executable, "-m", "gz_course.grader")
HELP = {
    "hint": ("Next hint", "where to look, which idea, another case"),
    "explain": ("Which line decides?", "found by trial, which takes about a minute"),
}
"""Sub-command of `course` -> its button, and what it shows."""


class Stuck(InNotebook):
    """The help on one exercise, shown as buttons where there are widgets, else as words."""

    def __init__(self, exercise: str, folder: Path) -> None:
        """Help with an exercise; the commands run in `folder`."""
        self.exercise, self.folder = exercise, folder

    def __repr__(self) -> str:
        return "\n".join(f"  !course {name} {self.exercise}   {shows}" for name, (_, shows) in HELP.items())

    def said(self, name: str) -> str:
        """Return what `course NAME EXERCISE` prints."""
        command = [*COMMAND, name, self.exercise]
        try:
            done = subprocess.run(
                command, cwd=self.folder, capture_output=True, text=True, timeout=_DEADLINE_S, check=False
            )
        except subprocess.TimeoutExpired:
            return f"`course {name} {self.exercise}` took longer than {_DEADLINE_S:g} s; run it in a terminal."
        return f"{done.stdout}{done.stderr}".strip()

    def _made_of(self, widgets: Any) -> Any:
        """Return a row of buttons with room for what they say."""
        answer = widgets.HTML()

        def button(name: str) -> Any:
            label, shows = HELP[name]
            made = widgets.Button(
                description=label,
                tooltip=f"course {name} {self.exercise}: {shows}",
                layout=widgets.Layout(width="max-content"),
            )

            def pressed(_: Any) -> None:
                answer.value = f"<p role='status'>course {name} {self.exercise} runs ...</p>"
                text = html.escape(self.said(name))
                answer.value = f"<pre role='status' style='white-space: pre-wrap'>{text}</pre>"

            made.on_click(pressed)
            return made

        return widgets.VBox([widgets.HBox([button(name) for name in HELP]), answer])
