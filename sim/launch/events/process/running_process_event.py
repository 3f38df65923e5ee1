"""What happens to a process: it starts, prints, reads and ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.launch.action import Action


class RunningProcessEvent(Event):
    """Base: tells the process by its action, label, command, folder, environment and number."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self, *, action: Action, name: str, cmd: list[str], cwd: str | None, env: dict[str, str] | None, pid: int
    ) -> None:
        self.__action = action
        self.__process_name = name
        self.__cmd = cmd
        self.__cwd = cwd
        self.__env = env
        self.__pid = pid

    @property
    def action(self) -> Action:
        """The action that started it."""
        return self.__action

    @property
    def execute_process_action(self) -> Action:
        """The same as `action`."""
        return self.__action

    @property
    def process_name(self) -> str:
        """Its label, `<name>-<number>`."""
        return self.__process_name

    @property
    def cmd(self) -> list[str]:
        """Its command."""
        return self.__cmd

    @property
    def cwd(self) -> str | None:
        """The folder it was started in; None for the launch's own."""
        return self.__cwd

    @property
    def env(self) -> dict[str, str] | None:
        """Its environment."""
        return self.__env

    @property
    def pid(self) -> int:
        """Its number."""
        return self.__pid


class ProcessStarted(RunningProcessEvent):
    """It has been started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """It has ended, with `returncode`; -n when signal n ended it."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__returncode = returncode

    @property
    def returncode(self) -> int:
        """The exit code."""
        return self.__returncode


class ProcessIO(RunningProcessEvent):
    """It has printed, or is to read, the bytes `text`; `fd` is 0, 1 or 2."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__text = text
        self.__fd = fd

    @property
    def text(self) -> bytes:
        """The bytes."""
        return self.__text

    @property
    def fd(self) -> int:
        """0 stdin, 1 stdout, 2 stderr."""
        return self.__fd

    @property
    def from_stdin(self) -> bool:
        """Whether it is for stdin."""
        return self.__fd == 0

    @property
    def from_stdout(self) -> bool:
        """Whether it comes from stdout."""
        return self.__fd == 1

    @property
    def from_stderr(self) -> bool:
        """Whether it comes from stderr."""
        return self.__fd == 2


class ProcessStdin(ProcessIO):
    """Asks to write `text` to the stdin of the process that `action` started."""

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=0, **kwargs)


class ProcessStdout(ProcessIO):
    """It has printed to stdout."""

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)


class ProcessStderr(ProcessIO):
    """It has printed to stderr."""

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=2, **kwargs)
