"""The HTML report: `as_html(report)` reads the recordings of its trials and fills `page.html.jinja`.

Imported by `grader/report/formats/html.py` when the page is written. A pure function of report and recordings: the page
of a recording that is scored again differs from the first only in the facts about the machine.
"""

from __future__ import annotations

import base64
import functools
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from gz_course.grader.printable import shown, storable
from gz_course.grader.record.reading import Recording
from gz_course.grader.report.html.animation import POLICY, SCRIPT, animation
from gz_course.grader.report.html.from_above import Map
from gz_course.grader.report.html.plot import key
from gz_course.grader.report.html.signals import Figure, figures_of, speeds_of
from gz_course.grader.report.node_log import node_log
from gz_course.grader.report.report import OUTCOMES, Report, TrialReport, points
from gz_course.grader.score.consequences import CheckResult

FOLDER = Path(__file__).parent
LONGEST = 4000  # characters of one text
CODE = re.compile(r"`([^`\n]+)`")
APART = 0.05  # [s] moments closer together than this are drawn once
MOST_VERDICTS = 4  # moments of failed checks that are drawn
MAP, FRAME = 640, 360  # [pixels] width of the large drawing and of the small ones
JPEG, PNG = b"\xff\xd8\xff", b"\x89PNG\r\n"


@dataclass(frozen=True)
class CheckRow:
    """One row of the table of checks; `trial` names the trial its finding comes from."""

    word: str
    title: str
    points: float
    max_points: float
    expected: str
    measured: str
    kept: str
    when: str
    hints: tuple[str, ...]
    trial: str


@dataclass(frozen=True)
class TrialRow:
    """One row of the table of trials, with a drawing of the path taken."""

    name: str
    seed: int
    points: float
    outcome: str
    failed: str
    truth_sha256: str
    drawing: Markup
    path: str


@dataclass(frozen=True)
class Plots:
    """The plots of one check."""

    word: str
    title: str
    trial: str
    figures: list[Figure]


@dataclass(frozen=True)
class Frame:
    """The world at one moment `at` [s] of the run."""

    at: float
    title: str
    where: str
    drawing: Markup


@dataclass(frozen=True)
class Picture:
    """One recorded camera image, as a data URI."""

    title: str
    alt: str
    source: Markup


def as_html(report: Report) -> str:
    """Return the report as one HTML page. Raises UsageError if a recording cannot be read."""
    trials = report.trials
    recordings = {trial.name: trial.content() for trial in trials}
    maps = {name: Map(recording, _robot(recording)) for name, recording in recordings.items()}
    shown_trial = report.shown_trial
    recording, drawn = recordings[shown_trial.name], maps[shown_trial.name]
    moments = _moments(shown_trial, recording)
    several = len(trials) > 1
    text = compiled("page.html.jinja").render(
        **_run(drawn, recording, moments),
        report=report,
        submission=Path(report.submission).name,
        style=Markup((FOLDER / "page.css").read_text()),
        outcome=OUTCOMES.get(report.score.outcome, report.score.outcome),
        several=several,
        shown_trial=f" (trial {shown_trial.name})" if several else "",
        checks=[_check_row(check, report) for check in report.score.checks],
        trials=[_trial_row(trial, maps[trial.name]) for trial in trials],
        plots=[group for check in report.score.checks if (group := _plots(check, trials, recordings)).figures],
        speeds=speeds_of(recording, _robot(recording)),
        pictures=_pictures(recording, moments),
        log=node_log(recording),
        noted=[f"{line.time_ns / 1e9:.2f} s: {shown(line.text)}" for line in recording.lines("log/grader")],
        facts=_facts(report),
        points=points,
        key=key,
    )
    return str(storable(text))


def replay_of(report: Report) -> tuple[str, str, Markup]:
    """Return the run of a report as a page of its own, its path in words, and a still picture of it (SVG).

    Raises UsageError if a recording cannot be read.
    """
    trial = report.shown_trial
    recording = trial.content()
    drawn = Map(recording, _robot(recording))
    run = _run(drawn, recording, _moments(trial, recording))
    style = Markup((FOLDER / "page.css").read_text())
    return str(storable(compiled("replay.html.jinja").render(**run, style=style))), run["path"], run["drawing"]


def _run(drawn: Map, recording: Recording, moments: list[tuple[float, str]]) -> dict[str, Any]:
    """Return what `run.html.jinja` shows: the drawing, and its motion if there is any."""
    end = _lasted(recording)
    moves = bool(drawn) and end > 0
    return {
        "drawing": _whole(drawn, recording),
        "motion": animation(drawn, end, MAP) if moves else Markup(""),
        "script": Markup(SCRIPT),
        "policy": Markup(POLICY),
        "end": end,
        "path": drawn.told(),
        "frames": [_frame(drawn, *moment) for moment in moments] if moves else [],
    }


@functools.cache
def compiled(name: str) -> Any:
    """Return a template of this folder, ready to be filled."""
    environment = Environment(
        loader=FileSystemLoader(FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_plain,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["worded"] = worded
    return environment.get_template(name)


def _plain(value: Any) -> Any:
    """Return foreign text on one line and shortened; leave our own markup unchanged."""
    return value if isinstance(value, Markup) or not isinstance(value, str) else shown(value, LONGEST)


def worded(text: str) -> Markup:
    """Return a sentence as a page shows it: what stands between backticks is code."""
    return Markup(CODE.sub(r"<code>\1</code>", str(escape(shown(text, LONGEST)))))


def _check_row(check: CheckResult, report: Report) -> CheckRow:
    finding, told = check.finding, dict(report.told(check))
    return CheckRow(
        word=_word(finding.passed),
        title=check.spec.title,
        points=check.points,
        max_points=check.spec.points,
        expected=finding.expected,
        measured=finding.measured,
        kept=told.get("kept", ""),
        when="" if finding.at_s is None else f"{finding.at_s:.2f} s",
        # Of a closed gate another check gives the reason.
        hints=() if finding.gated or "hint" not in told else check.spec.hints[: report.hints_shown],
        trial="" if finding.passed else _decisive(check, report.trials)[0].name,
    )


def _trial_row(trial: TrialReport, drawn: Map) -> TrialRow:
    failed = [check.spec.title for check in _failed(trial.score.checks)]
    path = drawn.told()
    drawing = drawn.draw(1e6, FRAME, path, whole_path=True) if drawn else Markup("")
    outcome = trial.score.outcome
    return TrialRow(
        trial.name, trial.seed, trial.score.points, outcome, ", ".join(failed), trial.truth_sha256, drawing, path
    )


def _plots(check: CheckResult, trials: tuple[TrialReport, ...], recordings: dict[str, Recording]) -> Plots:
    trial, decisive = _decisive(check, trials)
    figures = figures_of(decisive, recordings[trial.name])
    return Plots(_word(check.finding.passed), check.spec.title, trial.name, figures)


def _decisive(check: CheckResult, trials: tuple[TrialReport, ...]) -> tuple[TrialReport, CheckResult]:
    """Return the first trial in which a check failed, else the first trial, and what the check found there."""
    each = [(trial, one) for trial in trials for one in trial.score.checks if one.spec.id == check.spec.id]
    return next(((trial, one) for trial, one in each if not one.finding.passed), each[0])


def _failed(checks: tuple[CheckResult, ...]) -> list[CheckResult]:
    return [check for check in checks if not check.finding.passed]


def _word(passed: bool) -> str:
    return "pass" if passed else "FAIL"


def _robot(recording: Recording) -> str:
    return str(recording.properties("run").get("robot", "robot"))


def _lasted(recording: Recording) -> float:
    """Return the simulated duration of the run [s]; 0 if nothing was run."""
    return float(recording.facts().get("sim_seconds") or 0.0)


def _moments(trial: TrialReport, recording: Recording) -> list[tuple[float, str]]:
    """Return the moments to show, in order: start, middle, verdicts of failed checks, end."""
    end = _lasted(recording)
    found = [(0.0, "Start"), (end, "End")]
    failed = [check for check in _failed(trial.score.checks) if check.finding.at_s is not None]
    verdicts = [(float(check.finding.at_s or 0.0), f"{check.spec.title}: failed") for check in failed]
    for at, title in [*verdicts[:MOST_VERDICTS], (end / 2, "Middle")]:
        near = next((n for n, (other, _) in enumerate(found) if abs(other - at) < APART), None)
        if near is None:
            found.append((at, title))
        elif title != "Middle":
            found[near] = (found[near][0], f"{found[near][1]}. {title}")
    return sorted(found, key=lambda moment: moment[0])


def _whole(drawn: Map, recording: Recording) -> Markup:
    return drawn.draw(_lasted(recording), MAP, drawn.told(), whole_path=True) if drawn else Markup("")


def _frame(drawn: Map, at: float, title: str) -> Frame:
    where = drawn.where(at)
    alt = f"The world from above at {at:.2f} s of simulated time{f': the robot is at {where}' if where else ''}."
    return Frame(round(at, 3), f"{at:.2f} s. {title}", where, drawn.draw(at, FRAME, alt))


def _pictures(recording: Recording, moments: list[tuple[float, str]]) -> list[Picture]:
    """Return the recorded camera images at the given moments."""
    found = []
    for entity in [*recording.entities("world", "EncodedImage"), *recording.entities("topics", "EncodedImage")]:
        seen, name = b"", entity.removeprefix("topics")
        for at, title in moments:
            data = recording.picture_at(entity, round(at * 1e9))
            kind = "jpeg" if data.startswith(JPEG) else "png" if data.startswith(PNG) else ""
            if kind and data != seen:
                seen = data
                alt = f"Picture of {name} at {at:.2f} s of simulated time."
                source = Markup(f"data:image/{kind};base64,{base64.b64encode(data).decode()}")
                found.append(Picture(f"{at:.2f} s. {title} ({name})", alt, source))
    return found


def _facts(report: Report) -> list[tuple[str, Any]]:
    """Return further facts: about the run, then about the machine, which are not in a recording."""
    facts: list[tuple[str, Any]] = [
        ("Seeds", ", ".join(str(trial.seed) for trial in report.trials)),
        ("Simulated", f"{report.sim_seconds:g} s"),
        ("SHA-256 of the true path", report.score.truth_sha256),
        ("Versions", ", ".join(f"{name} {version}" for name, version in sorted(report.versions.items()))),
    ]
    if host := report.host:
        facts += [
            ("Recording", str(report.recording)),
            ("Graded file", report.submission),
            ("Isolation", f"level {host.sandbox}"),
            ("Pace", host.pace),
            ("Run", f"{host.run_wall_seconds:.2f} s on the wall clock; the whole command {host.wall_seconds:.2f} s"),
        ]
    else:
        facts.append(("Isolation, pace, speed", "known only to the report made when the submission was run"))
    return facts
