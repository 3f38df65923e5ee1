"""What the grader's tests share: the `course` command as a process of its own, and recordings made by hand."""

import dataclasses
import json
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import psutil
import pytest

from gz_course.tests import warm_process

with warnings.catch_warnings():
    # The parser that ROS's message packages bring along (lark) still imports a deprecated module.
    warnings.simplefilter("ignore", DeprecationWarning)
    import rosidl_generator_py  # noqa: F401

ROOT = Path(__file__).parents[2]
COURSE = [sys.executable, "-c", "from gz_course.grader.course import main; main()"]


@dataclasses.dataclass
class Outcome:
    """How one `course` command ended."""

    code: int
    stdout: str
    stderr: str
    folder: Path
    report: dict | None

    @property
    def output(self):
        return self.stdout + self.stderr

    @property
    def words(self):
        """The output on one line, however it was wrapped."""
        return " ".join(self.output.split())

    @property
    def recording(self):
        (path,) = (self.folder / "out").rglob("*.rrd")
        return path

    def failed(self):
        return {check["id"] for check in self.report["checks"] if check["status"] == "failed"}


def processes_of(folder):
    """Processes whose environment or command line names a folder: everything a run in it has started."""
    found = []
    for process in psutil.process_iter():
        try:
            told = [*process.environ().values(), *process.cmdline()]
        except (psutil.Error, OSError):
            continue
        if process.pid != os.getpid() and any(str(folder) in text for text in told):
            found.append(process)
    return found


def assert_nothing_left(outcome):
    """No process, no temporary folder, no unfinished recording, and no traceback of the grader's own."""
    left = processes_of(outcome.folder)
    for process in left:
        process.kill()
    assert not left, f"still running: {left}"
    assert [p.name for p in (outcome.folder / "tmp").iterdir()] == []
    assert list(outcome.folder.rglob("*.part")) == []
    assert "internal error" not in outcome.output, outcome.output
    # A frame of the grader in what a student is shown.
    assert not re.search(r'File "[^"]*/grader/', outcome.output), outcome.output


def environment(folder, **more):
    (folder / "tmp").mkdir(parents=True, exist_ok=True)
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "GZ_", "COURSE_"))}
    return kept | {"TMPDIR": str(folder / "tmp"), "COURSE_ROOT": str(ROOT), "COLUMNS": "100"} | more


def run_course(folder, *arguments, prelude="", timeout=600, **variables):
    """Run `course ARGUMENTS` in `folder`; `prelude` is Python that runs before the command."""
    command = [*COURSE[:-1], f"{prelude}\n{COURSE[-1]}"]
    done = warm_process.run(
        [*command, *map(str, arguments)],
        cwd=folder,
        env=environment(folder, **variables),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=timeout,
    )
    report = folder / "report.json"
    return Outcome(
        done.returncode,
        done.stdout.decode(),  # what the command prints is UTF-8, whatever the submission printed
        done.stderr.decode(),
        folder,
        json.loads(report.read_text()) if report.is_file() else None,
    )


def run_grade(folder, exercise, submission, *more, **options):
    """Grade a submission in `folder`, with the report beside it."""
    return run_course(
        folder, "grade", exercise, "--submission", submission, "--out", folder / "out",
        "--json", folder / "report.json", *more, **options,
    )  # fmt: skip


@pytest.fixture
def course(tmp_path):
    return lambda *arguments, **options: run_course(tmp_path, *arguments, **options)


@pytest.fixture
def grade(tmp_path):
    """Grade in the test's own folder; afterwards nothing may be left of it."""
    outcomes = []

    def call(exercise, submission, *more, **options):
        outcomes.append(run_grade(tmp_path, exercise, submission, *more, **options))
        return outcomes[-1]

    yield call
    for outcome in outcomes:
        assert_nothing_left(outcome)


@pytest.fixture(scope="session")
def grading():
    """The functions themselves, for fixtures that outlive a test."""
    return run_grade


@pytest.fixture(scope="session")
def running():
    """The same for any command."""
    return run_course


@pytest.fixture(scope="session")
def clean():
    return assert_nothing_left


@pytest.fixture(scope="session")
def running_in():
    return processes_of


@pytest.fixture(scope="session")
def course_environment():
    return environment


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture
def without_blueprint(monkeypatch):
    """Leave the layout of the viewer out of recordings: the SDK never frees the threads that it makes for one."""
    monkeypatch.setattr("gz_course.grader.record.recorder.blueprint", lambda *_: None)


@pytest.fixture
def record(tmp_path, without_blueprint):
    """Make a recording by hand: `record({"signal": [(seconds, value), ...]}, ...)` returns it, read back."""
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.record.recorder import Recorder

    numbers = iter(range(100_000))

    def make(signals=None, *, lines=(), log="log/student", arrays=None, facts=None, duration=8.0, **run):
        path = tmp_path / f"made-{next(numbers)}.rrd"
        with Recorder(path, "robot") as recorder:
            events = [(at, "scalar", name, value) for name, rows in (signals or {}).items() for at, value in rows]
            events += [(at, "array", name, value) for name, rows in (arrays or {}).items() for at, value in rows]
            events += [(at, "text", log, text) for at, text in lines]
            for at, kind, name, value in sorted(events, key=lambda event: event[0]):
                recorder.set_time(round(at * 1e9))
                getattr(recorder, kind)(name, value)
            properties = {"exercise": "made", "submission": "node.py", "seed": 0, "duration": duration} | run
            recorder.properties("run", **properties, facts=json.dumps(facts or {}))
        return Recording(path)

    return make
