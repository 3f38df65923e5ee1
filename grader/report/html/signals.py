"""The choice of plots: for each check its signals, and for the run the commands beside the truth.

Used by `page.py`. A check's signals are those of its bands; without bands those that its manifest names.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from gz_course.grader.record.reading import Recording
from gz_course.grader.report.html.plot import Area, Curve, Moment, number, plot
from gz_course.grader.score.consequences import CheckResult

MOST_FIGURES = 4  # plots of one check
SPEEDS = (
    ("Forward speed", "m/s", "linear_x", "linear/x"),
    ("Turning rate", "rad/s", "angular_z", "angular/z"),
)


@dataclass(frozen=True)
class Figure:
    """A plot with its title, its curves as (number, name), and the meaning of its band (empty without one)."""

    svg: Markup
    title: str
    names: list[tuple[int, str]]
    band: str


def figures_of(check: CheckResult, recording: Recording) -> list[Figure]:
    """Return a plot for each recorded signal that a check looked at."""
    finding, parameters = check.finding, check.spec.parameters
    bands = {name: [b for b in finding.bands if b.signal == name] for name in [b.signal for b in finding.bands]}
    areas = {name: [Area(b.low, b.high, b.start, b.end) for b in bands] for name, bands in bands.items()}
    if finding.gated:  # only the gate made it fail
        areas = _gates(parameters.get("gate"), _end(recording)) or areas
    named = list(areas) or list(_texts({key: value for key, value in parameters.items() if key != "gate"}))
    moment = None if finding.at_s is None else Moment(finding.at_s, finding.passed)
    behind = parameters.get("command")
    recorded = set(recording.signals())  # without lists of numbers
    figures: list[Figure] = []
    for name in dict.fromkeys(named):
        if name not in recorded:
            continue
        title = _name(name, parameters, recording)
        curves = [_curve(recording, name, title)]
        if isinstance(behind, str) and behind != name and not figures and behind in recorded:
            curves.append(_curve(recording, behind, _name(behind, {}, recording)))
        figures.append(_figure(recording, title, curves, areas.get(name, []), moment))
    return figures[:MOST_FIGURES]


def _gates(gate: Any, end: float) -> dict[str, list[Area]]:
    """Return the bands of a check's gate or gates, by signal."""
    areas: dict[str, list[Area]] = {}
    for each in gate if isinstance(gate, list) else [gate]:
        if isinstance(each, dict) and isinstance(each.get("signal"), str):
            low, high = float(each.get("reaches", -math.inf)), float(each.get("falls_to", math.inf))
            areas.setdefault(each["signal"], []).append(Area(low, high, 0.0, end))
    return areas


def speeds_of(recording: Recording, robot: str) -> list[Figure]:
    """Return plots of the robot's true speeds, each with the commands given for it.

    If there are several topics of commands, those that name the robot are used.
    """
    topics = sorted(recording.facts().get("listened", {}))
    own = [topic for topic in topics if robot in topic.split("/")] or topics
    figures = []
    for title, unit, truth, command in SPEEDS:
        name = f"truth/{robot}/{truth}"
        if not recording.has(name):
            continue
        curves = [_curve(recording, name, f"truth, {name}")]
        for topic in own:
            for signal in recording.entities(f"topics/{topic.strip('/')}", "Scalars:scalars"):
                if signal.endswith(f"/{command}"):
                    curves.append(_curve(recording, signal, f"command, {signal.removeprefix('topics')}"))
        figures.append(_figure(recording, f"{title} [{unit}]", curves[:4], [], None))
    return figures


def _figure(recording: Recording, title: str, curves: list[Curve], areas: list[Area], moment: Moment | None) -> Figure:
    end = _end(recording)
    svg = plot(curves, areas, moment, end, recording.ended_s, _told(title, curves, areas, moment, end))
    band = "wanted: " + "; ".join(dict.fromkeys(_bounds(area) for area in areas)) if areas else ""
    return Figure(svg, title, [(n, curve.name) for n, curve in enumerate(curves)], band)


def _told(title: str, curves: list[Curve], areas: list[Area], moment: Moment | None, end: float) -> str:
    """Return a plot in words, as its text alternative."""
    words = [f"{title} over {end:g} s of simulated time."]
    for curve in curves:
        if len(curve.values):
            low, high, last = (number(float(v)) for v in (curve.values.min(), curve.values.max(), curve.values[-1]))
            words.append(f"{curve.name}: from {low} to {high}, at last {last}.")
    words += [f"Wanted: {_bounds(area)}." for area in areas]
    if moment is not None:
        words.append(f"{'Passed' if moment.passed else 'Failed'} at {moment.at_s:.2f} s.")
    return " ".join(words)


def _bounds(area: Area) -> str:
    if math.isinf(area.high):
        wanted = f"at least {number(area.low)}"
    elif math.isinf(area.low):
        wanted = f"at most {number(area.high)}"
    else:
        wanted = f"{number(area.low)} to {number(area.high)}"
    return f"{wanted} at {area.end:g} s" if area.start == area.end else f"{wanted}, {area.start:g} s to {area.end:g} s"


def _curve(recording: Recording, name: str, title: str) -> Curve:
    signal = recording.signal(name)
    return Curve(title, signal.times / 1e9, signal.values)


def _name(signal: str, parameters: dict[str, Any], recording: Recording) -> str:
    """Return the display name of a signal: as in the manifest, else as in the recording."""
    for table in (parameters, *(t for t in parameters.get("conditions", []) if isinstance(t, dict))):
        if table.get("signal") == signal and "name" in table:
            return f"{table['name']} [{table['unit']}]" if "unit" in table else str(table["name"])
    return str(recording.static(signal).get("SeriesLines:names", signal.removeprefix("topics")))


def _texts(value: Any) -> Iterator[str]:
    """Yield every text in a manifest's parameters, at any depth."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for part in value.values():
            yield from _texts(part)
    elif isinstance(value, list):
        for part in value:
            yield from _texts(part)


def _end(recording: Recording) -> float:
    """Return the end of the time axis [s]: the duration of the exercise."""
    return float(recording.properties("run").get("duration") or 1.0)
