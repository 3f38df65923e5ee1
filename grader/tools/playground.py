"""A playground: commands such as `gz sim` and `parameter_bridge` run beside a notebook, and end with it.

    room = Playground()
    room.start("gz sim lidar_room.sdf -r -s")
    bridge = room.start("ros2 run ros_gz_bridge parameter_bridge --ros-args -p config_file:=bridge.yaml")
    bridge.wait_for("ready")
    print(room)                             # what runs
    !ros2 topic list                        # a notebook's own way to run a command and wait for its end
    room.close()

Programs are started as in a terminal: ordinary processes that exchange messages with each other, and with your node,
over DDS and Gazebo's transport. A playground adds three things: a ROS domain and a Gazebo partition that nothing else
on this machine uses, their output, and their end: with `close()`, at the end of a `with` block, or with the notebook's
kernel, whichever comes first.

A cell of a notebook may be run repeatedly: a new playground closes the one before it, and a command that is started
again ends its first run.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import psutil

from gz_course.grader.errors import UsageError
from gz_course.grader.lessons.notebook import Classroom
from gz_course.grader.printable import shown
from gz_course.grader.process.load import crowded
from gz_course.grader.process.temporary_folder import TemporaryFolder, sweep
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.sandbox import ros_environment
from gz_course.grader.run.sandbox.environment import in_force
from gz_course.grader.run.sandbox.resource_monitor import descendants
from gz_course.sim import jupyter_proxy
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.lessons.questions import Ask
    from gz_course.grader.lessons.stuck import Stuck
    from gz_course.grader.report.html.replay import Replay
    from gz_course.grader.tools.live_frame import LiveFrame, WorldView

GRACE = 3.0  # [s] between SIGINT, SIGTERM and SIGKILL
LONGEST_COMMAND = 100  # [characters] of a command in the list of running programs
# Its page goes into the notebook: no window or browser is opened.
WATCH = "env -u DISPLAY -u WAYLAND_DISPLAY course watch --web"
WATCH_READY = "Ctrl-C ends it"
ADDRESS = re.compile(r"http://\S+")
ANEW = 9
LOOK_AGAIN = 0.02  # [s] between two looks at the output of a program
# Executes the command after asking Linux (prctl 1, PR_SET_PDEATHSIG) for a SIGTERM at the end of the process that
# started it, because a notebook kernel that is killed cannot clean up. Run without site packages, so it takes only
# milliseconds.
_LAUNCHER = """
import ctypes, os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[3:])
"""


class Program:
    """A started command: `pid`, `exit_code` (None while it runs) and its `output` so far."""

    def __init__(self, command: str, executable: str, words: list[str], log: Path) -> None:
        """Start `words` in a new process group, with its output in the file `log`."""
        self.command = command
        self._log = log
        self._text: str | None = None
        with log.open("wb") as sink:
            self._process = subprocess.Popen(
                [sys.executable, "-I", "-S", "-c", _LAUNCHER, str(os.getpid()), executable, *words],
                stdin=subprocess.DEVNULL,
                stdout=sink,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """Process id, and id of its process group."""
        return self._process.pid

    @property
    def exit_code(self) -> int | None:
        """Exit code; None while it runs, minus the signal's number if a signal ended it."""
        return self._process.poll()

    @property
    def stopped(self) -> bool:
        """Has `stop` ended it?"""
        return self._text is not None

    @property
    def output(self) -> str:
        """Its output so far, stdout and stderr in the order written."""
        return self._log.read_text(errors="replace") if self._text is None else self._text

    def wait_for(self, text: str, deadline: float = 30.0) -> str:
        """Wait until it has printed `text`; return its output so far.

        Raises TimeoutError, with the output, if it ends or `deadline` [s] pass before that. Time in which the programs
        of this process wait for a processor does not count, and on a crowded machine the deadline begins anew, up to
        `ANEW` times. The error says how long it has computed.
        """
        clock = FairClock(lambda: [os.getpid(), *descendants(os.getpid())])
        patience, waits = Patience(clock, deadline), 1
        pause = threading.Event()
        while True:
            ended = self.exit_code is not None  # asked first, because it may print before it ends
            if text in (output := self.output):
                return output
            if ended or patience.over():
                if not ended and waits <= ANEW and crowded():
                    patience, waits = Patience(clock, deadline), waits + 1
                    continue
                reason = "has ended and" if ended else f"has, within {waits * deadline:g} s,"
                state = "" if ended else f" ({self._state()})"
                raise TimeoutError(f"{self.command} {reason} not printed {text!r}{state}, but:\n{output}")
            pause.wait(LOOK_AGAIN)

    def _state(self) -> str:
        """Say how much it has computed, which tells a slow program from one that waits for something."""
        used = 0.0
        for pid in (self.pid, *descendants(self.pid)):
            with contextlib.suppress(psutil.Error):
                times = psutil.Process(pid).cpu_times()
                used += times.user + times.system
        return f"it runs, and has had {used:.1f} s of processor time"

    def stop(self) -> int:
        """End it as Ctrl-C would (SIGINT), if necessary with SIGTERM and SIGKILL; return its exit code."""
        if self._text is None:
            for escalation in (signal.SIGINT, signal.SIGTERM):
                self._signal(escalation)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(GRACE)
                    break
            self._signal(signal.SIGKILL)  # everything it started and did not end
            self._process.wait()
            self._text = self.output
        return int(self._process.returncode)

    def _signal(self, number: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.pid, number)

    def __repr__(self) -> str:
        state = "running" if self.exit_code is None else f"ended with exit code {self.exit_code}"
        return f"<{self.command}: process {self.pid}, {state}>"


class Playground:
    """A ROS domain, a Gazebo partition, and the programs started in them; also a context manager.

    While it is open, `os.environ` holds what a node of this process needs to be in the same domain and partition: make
    the playground before `rclpy.init()`. There can be only one, so a new playground closes the one before it. The
    course's commands are put on the PATH and stay there. Use it from the main thread, in which a notebook's cells run:
    Linux ends the programs when the thread that started them ends.
    """

    _opened: Playground | None = None

    def __init__(self) -> None:
        """Reserve the domain. Raises InfrastructureError if none is free."""
        if Playground._opened is not None:
            Playground._opened.close()
        _put_on_path(Path(sys.executable).parent)
        self._domain = Domain()
        sweep()  # removes what playgrounds of killed notebooks left
        self._temporary = TemporaryFolder("playground-")
        self._folder = self._temporary.path
        self.programs: list[Program] = []
        self.environment = ros_environment(self._domain.id, self._folder / "ros_log") | {
            "GZ_IP": "127.0.0.1",
            "GZ_PARTITION": f"playground-{self._domain.id}",
            "PYTHONUNBUFFERED": "1",
        }
        self._variables = in_force(self.environment)
        self._variables.__enter__()
        self._view: WorldView | None = None
        self._open = True
        Playground._opened = self
        atexit.register(self.close)
        self._classroom = Classroom(self, Path.cwd())
        self._classroom.begin()

    @property
    def domain(self) -> int:
        """Its ROS domain (ROS_DOMAIN_ID)."""
        return self._domain.id

    @property
    def partition(self) -> str:
        """Its Gazebo partition (GZ_PARTITION)."""
        return self.environment["GZ_PARTITION"]

    @property
    def closed(self) -> bool:
        """Has it been closed?"""
        return not self._open

    @property
    def running(self) -> list[Program]:
        """The programs that have not ended yet."""
        return [program for program in self.programs if program.exit_code is None]

    def start(self, command: str, instead_of: str | None = None) -> Program:
        """Start a command as a terminal would, without waiting for it.

        The words are split and unquoted as in a shell, but there are no shell features such as pipes. Running commands
        that begin with `instead_of` (the command itself if left out) are stopped before: `instead_of="gz sim"` leaves
        only one simulator. Raises UsageError if there is no such command.
        """
        if not self._open:
            raise UsageError("this playground is closed; make a new one with Playground()")
        words = shlex.split(command)
        if not words:
            raise UsageError("which command? For example: gz sim lidar_room.sdf -r -s")
        executable = shutil.which(words[0])
        if executable is None:
            known = [path.name for path in Path(sys.executable).parent.iterdir()]
            raise UsageError(f"there is no command {words[0]!r}{did_you_mean(words[0], known, listing='known')}")
        for before in self.running:
            if before.command.startswith(command if instead_of is None else instead_of):
                before.stop()
        program = Program(command, executable, words, self._folder / f"{len(self.programs)}.log")
        self.programs.append(program)
        return program

    def show(self, world: str = "") -> LiveFrame:
        """Return a frame with the simulated world, live: the one of that name, or the first that answers.

        It ends with the playground, and when it is asked for again.
        """
        from gz_course.grader.tools.live_frame import WorldView

        if not self._open:
            raise UsageError("this playground is closed; make a new one with Playground()")
        if self._view is not None:
            self._view.close()
        self._view = WorldView(world)
        return self._view.frame

    def watch(self, *topics: str) -> LiveFrame:
        """Return a frame with what ROS says on these topics (all, if none is given), live; `course watch` draws it.

        It is a program like those of `start`, and a further call ends it.
        """
        from gz_course.grader.tools.live_frame import LiveFrame
        from gz_course.sim.show.rviz2.inline import NOT_HERE

        if jupyter_proxy.is_between():
            return LiveFrame(f"What ROS says on {', '.join(topics) or 'all topics'}: {NOT_HERE}.")
        program = self.start(f"{WATCH} {shlex.join(topics)}", instead_of=WATCH)
        try:
            address = ADDRESS.search(program.wait_for(WATCH_READY))
        except TimeoutError:
            address = None
        if address is None:
            said = program.output.strip().rpartition("\n")[2]
            program.stop()
            return LiveFrame(f"There is no live picture of what ROS says: {said}")
        return LiveFrame(f"What ROS says on {', '.join(topics) or 'all topics'}, live.", address[0])

    def replay(self, recording: str | Path) -> Replay:
        """Return the run of a recording, to be played and stepped through in the page. Raises UsageError."""
        from gz_course.grader.grade import grade_again
        from gz_course.grader.report.html.replay import Replay

        return Replay(grade_again(Path(recording)))

    def predict(self, name: str, choice: int | str | None = None) -> Ask:
        """Ask what the next cell will show; `choice` is the number of an answer, or a line of text.

        The answer is kept beside the notebook, and stands beside the output of the next cell. Raises UsageError.
        """
        return self._classroom.predict(name, choice)

    def review(self, chapter: str, number: int = 0, choice: int | str | None = None) -> Any:
        """Ask the questions of a chapter, or answer one of them by its number. Raises UsageError."""
        return self._classroom.review(chapter, number, choice)

    def stuck(self) -> Stuck:
        """Return buttons for the next hint and for `course explain`, or the commands where there are no widgets."""
        return self._classroom.stuck()

    def report(self) -> str:
        """Return which programs run and which have ended, with their output: to be read when no messages arrive."""
        return "\n".join(f"{program!r}\n{program.output}" for program in self.programs)

    def close(self) -> None:
        """End every program, last started first, and restore domain and environment. Closing twice does nothing."""
        if not self._open:
            return
        self._open = False
        Playground._opened = None
        atexit.unregister(self.close)
        try:
            if self._view is not None:
                self._view.close()
            for program in reversed(self.programs):
                program.stop()
        finally:
            self._variables.__exit__(None, None, None)
            self._domain.release()
            self._temporary.close()

    def __repr__(self) -> str:
        if not self._open:
            return "<playground: closed, nothing is running>"
        lines = [f"  process {p.pid}  {shown(p.command, LONGEST_COMMAND)}" for p in self.running] or ["  nothing"]
        return "\n".join([f"running with ROS_DOMAIN_ID={self.domain}, GZ_PARTITION={self.partition}:", *lines])

    def __enter__(self) -> Playground:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _put_on_path(folder: Path) -> None:
    """Put a folder first on the PATH, so that its commands are found even if the environment is not activated."""
    path = [part for part in os.environ.get("PATH", os.defpath).split(os.pathsep) if part != str(folder)]
    os.environ["PATH"] = os.pathsep.join([str(folder), *path])
