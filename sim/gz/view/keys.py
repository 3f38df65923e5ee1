"""The keys of the view, a row each: what is pressed, what it does, and the method of `Keyboard` that does it.

The panel Keys shows them, the page has them for screen readers, and `keyboard.py` obeys them.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """One row. `chords` are names of Dear ImGui's keys, `Shift+E` with Shift; none: the panel Teleop takes them."""

    shown: str
    does: str
    action: str = ""
    chords: tuple[str, ...] = ()
    held: bool = False
    """Whether it acts as long as it is held; the action then gets the number of the chord."""


_PUSHES = ("Shift+UpArrow", "Shift+DownArrow", "Shift+LeftArrow", "Shift+RightArrow", "Shift+A", "Shift+D")
_PANS = ("Shift+I", "Shift+K", "Shift+J", "Shift+L")
KEYS = (
    Key("Space", "play or pause", "toggle_pause", ("Space",)),
    Key("N", "step, while paused", "step", ("N",)),
    Key("Backspace", "reset the world", "reset", ("Backspace",)),
    Key("Arrows, W A S D", "drive the robot"),
    Key("E, Shift+E", "select the next or the previous model", "select", ("E", "Shift+E")),
    Key("F", "follow the selected model, or stop following", "follow", ("F",)),
    Key("Shift+Arrows", "push the selected model; while paused, move it", "push", _PUSHES, held=True),
    Key("Shift+A, Shift+D", "turn the selected model left or right"),
    Key("Delete", "remove the selected model", "remove", ("Delete",)),
    Key("I K J L", "turn the camera up, down, left, right", "turn", ("I", "K", "J", "L"), held=True),
    Key("Shift+I K J L", "move the camera", "pan", _PANS, held=True),
    Key("Page Up, Page Down", "camera nearer or further", "zoom", ("PageUp", "PageDown"), held=True),
    Key("Home", "see the whole world", "look_at_all", ("Home",)),
    Key("H, F1", "show these keys", "show_keys", ("H", "F1")),
    Key("F2", "use the panels by keys: arrows, Space; F2 for the next panel", "enter_panels", ("F2",)),
    Key("Escape", "leave the panels, or let go of what is selected", "leave", ("Escape",)),
)
ALWAYS = ("enter_panels", "leave", "show_keys")
"""Actions whose function keys, and Escape, work while a panel has the keys."""
