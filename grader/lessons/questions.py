"""Predictions and questions of review as a notebook shows them: buttons where there are widgets, else words.

Used by `notebook.py`. A choice is kept as soon as it is made.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.grader.lessons.in_notebook import InNotebook
from gz_course.grader.lessons.lesson import Question

NOTHING = "You made no prediction."


class Ask(InNotebook):
    """A question in a notebook: shows the choices, and calls `chosen` with the words of the one taken."""

    def __init__(self, question: Question, call: str, said: str | None, chosen: Callable[[str], str]) -> None:
        """Show a question; `call` is what to type instead of a click, and `said` the choice made before."""
        self._question, self._call, self._said, self._chosen = question, call, said, chosen

    def __repr__(self) -> str:
        choices = [f"  {number}  {text}" for number, text in enumerate(self._question.choices, start=1)]
        example = 1 if choices else '"..."'
        said = f"Your answer: {self._said}" if self._said else f"To answer, write {self._call.format(example)}"
        return "\n".join([*filter(None, [self._question.question]), *choices, said])

    def _made_of(self, widgets: Any) -> Any:
        """Return radio buttons or a line of text."""
        answer = widgets.HTML()
        choices = self._question.choices
        said = self._said or None
        if choices:
            box = widgets.RadioButtons(
                options=choices, value=said if said in choices else None, layout=widgets.Layout(width="max-content")
            )
        else:
            box = widgets.Text(value=said or "", placeholder="your prediction", layout=widgets.Layout(width="90%"))

        def take(change: Any) -> None:
            if change["new"]:
                answer.value = self._chosen(str(change["new"]))

        box.observe(take, "value")
        title = [widgets.HTML(self._question.question)] if self._question.question else []
        return widgets.VBox([*title, box, answer])


def beside(question: Question, said: str | None) -> str:
    """Return what stands beside the outcome of a prediction: what was said, what it is, and why."""
    if not said:
        right = f" It is: {question.right}." if question.right else ""
        return f"{NOTHING}{right} {question.why}"
    if not question.right:
        return f"You predicted: {said}. {question.why}"
    if said == question.right:
        return f"As you predicted: {said}. {question.why}"
    return f"You predicted: {said}. It is: {question.right}. {question.why}"


def judged(question: Question, said: str) -> str:
    """Return what is said to the answer of a question of review."""
    return f"{'Right' if said == question.right else f'No, it is: {question.right}'}. {question.why}"
