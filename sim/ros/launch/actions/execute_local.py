"""The action that runs a process on this machine; the base of ExecuteProcess and thereby of launch_ros' Node.

`execute` prepares the command; the process (`launch.child_process`) starts after the whole launch description has been
visited, and ends with the launch.
"""

from __future__ import annotations

import asyncio
import contextlib
import signal
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim import machine_clock
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.actions.emit_event import EmitEvent
from gz_course.sim.ros.launch.child_process import ChildProcess
from gz_course.sim.ros.launch.conditions.evaluate_condition_expression_impl import (
    as_bool,
    evaluate_condition_expression,
)
from gz_course.sim.ros.launch.descriptions.executable import Executable
from gz_course.sim.ros.launch.errors import LaunchError, UsedTwiceError, locate, sentence
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler, answer, known_entities
from gz_course.sim.ros.launch.events import Shutdown
from gz_course.sim.ros.launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdin,
    ProcessStdout,
    ProcessTargetedEvent,
    ShutdownProcess,
    SignalProcess,
)
from gz_course.sim.ros.launch.frontend.flag import read_flag
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.process_output import ProcessOutput
from gz_course.sim.ros.launch.process_settings import (
    ProcessSettings,
    normalized_output,
    performed_output,
    plain_or_substitutions,
    seconds,
    timeout_substitutions,
    whole_number,
    why_not_started,
)
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser

_IO_EVENTS = {"stdout": ProcessStdout, "stderr": ProcessStderr}
# The attributes of an XML or YAML launch file, with their types.
_ATTRIBUTES: dict[str, Any] = {
    "output": str,
    "output_format": str,
    "respawn": str,
    "respawn_max_retries": int,
}
_TIMES = ("respawn_delay", "sigterm_timeout", "sigkill_timeout")  # attributes [s] that can be numbers only
_GRACE = 1.0  # [s] for background processes, after the process itself has ended
OnExit = SomeEntitiesType | Callable[[ProcessExited, LaunchContext], SomeEntitiesType | None] | None


class ExecuteLocal(Action):
    """Runs a `process_description`.

    `output` selects where its output goes (`launch.process_output`); `emulate_tty` gives it a pseudo-terminal;
    `cached_output` keeps its output for `get_stdout` and `get_stderr`; `log_cmd` logs its command. `on_exit` is handled
    like that of OnProcessExit. With `respawn` it is restarted when it ends, after `respawn_delay` [s], at most
    `respawn_max_retries` times (-1: without limit). At the end of the launch it gets SIGINT, after `sigterm_timeout`
    [s] SIGTERM, and after another `sigkill_timeout` [s] SIGKILL.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: SomeSubstitutionsType | float | None = None,
        sigkill_timeout: SomeSubstitutionsType | float | None = None,
        emulate_tty: bool | SomeSubstitutionsType = False,
        output: Any = "log",
        output_format: str | None = None,
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: OnExit = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | SomeSubstitutionsType | None = None,
        respawn_max_retries: int | SomeSubstitutionsType = -1,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.process_description = process_description
        self.shell = shell
        self.__timeouts = {
            signal.SIGINT: timeout_substitutions("sigterm_timeout", sigterm_timeout),
            signal.SIGTERM: timeout_substitutions("sigkill_timeout", sigkill_timeout),
        }
        self.emulate_tty = emulate_tty
        self.output = normalized_output(output)
        self.__output_format = output_format
        self.__cached_output = cached_output
        self.__log_cmd = log_cmd
        self.__on_exit = on_exit
        if on_exit is not None:
            known_entities(on_exit, "on_exit")
        self.__respawn = plain_or_substitutions(respawn)
        self.__respawn_delay = plain_or_substitutions(0.0 if respawn_delay is None else respawn_delay)
        self.__respawn_max_retries = plain_or_substitutions(respawn_max_retries)
        self.__task: asyncio.Task[None] | None = None
        self.__child: ChildProcess | None = None
        self.__printed: ProcessOutput | None = None
        self.process_details: dict[str, Any] | None = None
        self.return_code: int | None = None
        self.__stopping: asyncio.Task[None] | None = None
        self.__must_stop = asyncio.Event()
        self.__ended = asyncio.Event()
        self.__gone = asyncio.Event()

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: Iterable[str] = ()) -> tuple[Any, dict[str, Any]]:
        """Read the attributes of a process, those in `ignore` aside."""
        _, options = super().parse(entity, parser)
        for name, data_type in _ATTRIBUTES.items():
            value = None if name in ignore else entity.get_attr(name, data_type=data_type, optional=True)
            if value is not None:
                options[name] = parser.parse_if_substitutions(value)
        for name in _TIMES:
            time = None if name in ignore else entity.get_attr(name, data_type=float, optional=True, can_be_str=False)
            if time is not None and time < 0.0:
                raise LaunchError(f"{name}={time} is less than 0")
            options |= {} if time is None else {name: time}
        for name in ("shell", "emulate_tty"):
            options |= {} if name in ignore else read_flag(entity, name)
        if "on_exit" not in ignore and (reaction := entity.get_attr("on_exit", optional=True)) is not None:
            if reaction != "shutdown":
                raise LaunchError(f"on_exit is '{reaction}'; it can be 'shutdown'")
            options["on_exit"] = EmitEvent(event=Shutdown(reason="a required process has ended"))
        return cls, options

    def get_stdout(self) -> str:
        """Return the output so far. Raises LaunchError without `cached_output`."""
        return self._cached("stdout")

    def get_stderr(self) -> str:
        """Return the output so far. Raises LaunchError without `cached_output`."""
        return self._cached("stderr")

    def _cached(self, stream: str) -> str:
        return "" if self.__printed is None else self.__printed.cached(stream).decode(errors="replace")

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return [] if self.__on_exit is None else known_entities(self.__on_exit, "on_exit")

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Any]]:
        entities = self.get_sub_entities()
        return [(f"When {self.describe()} has ended", entities)] if entities else []

    def get_asyncio_future(self) -> asyncio.Future[None] | None:
        return self.__task

    def prepare(self, context: LaunchContext) -> None:
        self.process_description.prepare(context, self)

    def cleanup(self) -> None:
        """Remove the temporary results of `prepare` after the last end of the process."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Prepare the command and schedule its start.

        Raises UsedTwiceError if it was executed before, and the errors of its substitutions.
        """
        if self.__task is not None:
            raise UsedTwiceError(
                f"{self.describe()} is executed a second time; an action can only be executed once, make another one"
            )
        loop = context.asyncio_loop
        if loop is None:
            raise LaunchError("processes can only be started by a LaunchService that runs")
        if context.is_shutdown:
            launch_logging.get_logger("launch").info(f"not started, for the launch is shutting down: {self.describe()}")
            return None
        self.prepare(context)
        label = self.process_description.final_name
        assert label is not None
        settings = ProcessSettings(
            output=performed_output(self.output, context),
            emulate_tty=evaluate_condition_expression(context, plain_or_substitutions(self.emulate_tty))
            or as_bool(context.launch_configurations.get("emulate_tty", "")) is True,
            respawn=evaluate_condition_expression(context, self.__respawn),
            respawn_delay=seconds(context, self.__respawn_delay),
            respawn_max_retries=whole_number(context, self.__respawn_max_retries),
            timeouts={number: seconds(context, parts) for number, parts in self.__timeouts.items()},
            logger=launch_logging.get_logger(label),
        )
        line_format = self._line_format() if self.__output_format is not None else None
        self.__printed = ProcessOutput(label, settings.output, cached=self.__cached_output, line_format=line_format)
        with context.uninterrupted():
            context.register_event_handler(_ProcessHandler(self, settings))
            self.__task = loop.create_task(self._run(context, settings))
        return None

    def _line_format(self) -> Callable[[str], str]:
        text = self.__output_format or ""
        return lambda line: text.format(this=self, line=line)

    async def _run(self, context: LaunchContext, settings: ProcessSettings) -> None:
        """Run the process with all its restarts."""
        try:
            retries = 0
            while not (context.is_shutdown or self.__must_stop.is_set()):
                if not await self._run_once(context, settings) or not settings.respawn:
                    break
                if 0 <= settings.respawn_max_retries <= retries:
                    break
                retries += 1
                await _happens(self.__must_stop, settings.respawn_delay)
        except Exception as error:
            locate(error, self._place)
            raise
        finally:
            self.cleanup()

    async def _run_once(self, context: LaunchContext, settings: ProcessSettings) -> bool:
        """Run the process once; return whether it may be restarted."""
        child = self._start(context, settings)
        if child is None:
            return False
        self.__child = child
        self.__ended.clear()
        self.__gone.clear()
        assert self.process_details is not None and self.__printed is not None
        try:
            code = await child.wait()
            self.__printed.flush()
            self.return_code = code
            if code == 0:
                settings.logger.info(f"process has finished cleanly [pid {child.pid}]")
            else:
                words = " ".join(self.process_details["cmd"])
                settings.logger.error(f"process has died [pid {child.pid}, exit code {code}, cmd '{words}'].")
            context.emit_event_sync(ProcessExited(returncode=code, action=self, **self.process_details))
            self.__ended.set()
            if child.has_background_processes():
                await self._wait_for_group(child, context, settings)
        except asyncio.CancelledError:  # the event loop ends before the launch
            child.kill()
            raise
        finally:
            self.__ended.set()
            self.__gone.set()
            if self.__stopping is not None:
                await self.__stopping
            child.close()
            self.__printed.close()
        return not self.__must_stop.is_set()

    async def _wait_for_group(self, child: ChildProcess, context: LaunchContext, settings: ProcessSettings) -> None:
        """Wait for the background processes of the process, which also belong to the launch."""
        if settings.respawn and not context.is_shutdown:
            child.send_signal(signal.SIGKILL)  # before the restart
        elif not context.is_shutdown:
            settings.logger.warning(
                "it has left processes in the background; the launch waits for them, and ends them when it ends"
            )
        await child.wait_for_group()

    def _start(self, context: LaunchContext, settings: ProcessSettings) -> ChildProcess | None:
        """Start the process; return None, after an error in the log, if that fails. The others run on."""
        description = self.process_description
        command = description.final_cmd or []
        printed = self.__printed
        assert printed is not None

        def take(stream: str, data: bytes) -> None:
            printed.feed(stream, data)
            event = _IO_EVENTS[stream](text=data, action=self, **(self.process_details or {}))
            if context.would_handle_event(event):
                context.emit_event_sync(event)

        if self.__log_cmd:
            settings.logger.info(
                f"process details: cmd='{' '.join(command)}', cwd='{description.final_cwd}', "
                f"custom_env?={description.env is not None or description.additional_env is not None}"
            )
        try:
            child = ChildProcess(
                " ".join(command) if self.shell else command,
                shell=self.shell,
                cwd=description.final_cwd,
                env=description.final_env,
                emulate_tty=settings.emulate_tty,
                on_output=take,
            )
        except (OSError, ValueError) as error:
            failure = LaunchError(why_not_started(error, command, description.final_cwd, context))
            locate(failure, self._place)
            settings.logger.error(sentence(failure))
            return None
        self.process_details = {
            "name": description.final_name,
            "pid": child.pid,
            "cmd": command,
            "cwd": description.final_cwd,
            "env": description.final_env,
        }
        settings.logger.info(f"process started with pid [{child.pid}]")
        context.emit_event_sync(ProcessStarted(action=self, **self.process_details))
        return child

    def _stop(self, settings: ProcessSettings, *, silent: bool) -> None:
        """Start ending the process: SIGINT, then SIGTERM, then SIGKILL."""
        self.__must_stop.set()
        running = self.__child is not None and not self.__gone.is_set()
        if running and self.__stopping is None:
            self.__stopping = asyncio.get_running_loop().create_task(self._escalate(settings, silent=silent))

    async def _escalate(self, settings: ProcessSettings, *, silent: bool) -> None:
        label = self.process_description.final_name
        for number, following in ((signal.SIGINT, signal.SIGTERM), (signal.SIGTERM, signal.SIGKILL)):
            self._signal(number, settings, silent=silent and number == signal.SIGINT)
            patience = settings.timeouts[number]
            if await _happens(self.__ended, patience):
                # Background processes of a shell ignore SIGINT, so a long wait is useless.
                if await _happens(self.__gone, min(patience, _GRACE)):
                    return
            else:
                settings.logger.error(
                    f"process[{label}] failed to terminate '{patience:g}' seconds after receiving "
                    f"'{number.name}', escalating to '{following.name}'"
                )
        self._signal(signal.SIGKILL, settings)

    def _signal(self, number: signal.Signals, settings: ProcessSettings, *, silent: bool = False) -> None:
        if self.__child is None or self.__gone.is_set():
            settings.logger.warning(f"signal '{number.name}' is not sent: the process does not run")
            return
        if not silent:
            label = self.process_description.final_name
            settings.logger.info(f"sending signal '{number.name}' to process[{label}]")
        self.__child.send_signal(number)

    def _handle(self, event: Event, context: LaunchContext, settings: ProcessSettings) -> list[LaunchDescriptionEntity]:
        if isinstance(event, ProcessExited):
            return answer(self.__on_exit, event, context, "on_exit")
        if isinstance(event, Shutdown):
            # Ctrl-C at a terminal needs no explanation.
            at_terminal = not context.noninteractive and sys.stdin is not None and sys.stdin.isatty()
            self._stop(settings, silent=event.due_to_sigint and at_terminal)
        elif isinstance(event, ShutdownProcess):
            self._stop(settings, silent=False)
        elif isinstance(event, SignalProcess):
            self._signal(event.signal, settings)
        elif isinstance(event, ProcessStdin) and self.__child is not None:
            self.__child.write(event.text)
        return []

    def _concerns(self, event: Event) -> bool:
        if isinstance(event, ProcessExited):
            return self.__on_exit is not None and event.action is self
        if isinstance(event, ProcessTargetedEvent):
            return bool(event.process_matcher(self))
        return isinstance(event, Shutdown) or (isinstance(event, ProcessStdin) and event.action is self)


class _ProcessHandler(EventHandler):
    """Passes the events of a process to its action."""

    def __init__(self, action: ExecuteLocal, settings: ProcessSettings) -> None:
        super().__init__(matcher=action._concerns)
        self._action = action
        self._settings = settings

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return self._action._handle(event, context, self._settings)


async def _happens(event: asyncio.Event, within: float) -> bool:
    """Wait for an event for `within` [s] of the machine; return whether it was set."""
    end = machine_clock.now() + within
    while not event.is_set() and (left := end - machine_clock.now()) > 0:
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(event.wait(), left)
    return event.is_set()
