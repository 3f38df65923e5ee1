"""Runs launch descriptions: visits them, passes events to event handlers, and ends every process that was started.

    service = LaunchService()
    service.include_launch_description(description)
    exit_code = service.run()

Events are processed one after the other: each is offered to all handlers, and the returned entities are visited. The
run ends when every process, timer and coroutine has ended after a shutdown; an idle launch shuts down by itself.

Source: ros2/launch, launch/launch/launch_service.py and launch/doc/source/architecture.rst
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import signal
import socket
import threading
import traceback
from collections.abc import Callable, Coroutine, Iterable
from types import FrameType

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.postponed_signal import postponed
from gz_course.sim.ros.launch.errors import LaunchError, sentence
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.events import IncludeLaunchDescription, Shutdown
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_entity import listed, visit

_OTHER_ENDS = (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
_LOG = launch_logging.get_logger("launch")


class LaunchService:
    """One run. `argv` is stored for launch files that read it; `noninteractive` means that no user is at a terminal."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        self.context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.__return_code = 0
        self.__is_running = False
        self.__lock = threading.Lock()
        self.__visiting = False
        self.__loop: asyncio.AbstractEventLoop | None = None
        if debug:
            launch_logging.launch_config.level = "DEBUG"

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """Return the event loop while it runs, else None."""
        return self.__loop

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        self.emit_event(IncludeLaunchDescription(launch_description))

    def emit_event(self, event: Event) -> None:
        """Queue an event before or during the run; thread-safe."""
        self.context.emit_event_sync(event)

    def shutdown(self, force_sync: bool = False) -> Coroutine[None, None, None] | None:
        """End the run as if it were idle; thread-safe.

        Called in the event loop of the run it returns a coroutine that completes at once, for `await`.
        """
        self.emit_event(Shutdown(reason="LaunchService.shutdown() called"))
        try:
            inside = asyncio.get_running_loop() is self.__loop
        except RuntimeError:
            inside = False
        return _nothing() if inside and not force_sync else None

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until the end; return 0, or 1 if the launch itself failed. Works in any thread, also beside a running
        loop.

        Exit codes of processes are ignored. In the main thread SIGINT, SIGTERM, SIGHUP and SIGQUIT end the run.
        """
        work = self.run_async(shutdown_when_idle=shutdown_when_idle)
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            with asyncio.Runner() as runner:
                return runner.get_loop().run_until_complete(work)
        return self._run_in_thread(work)

    def _run_in_thread(self, work: Coroutine[None, None, int]) -> int:
        """Run in another thread while the event loop of this one waits, as in a notebook."""
        outcome: concurrent.futures.Future[int] = concurrent.futures.Future()

        def run() -> None:
            try:
                outcome.set_result(asyncio.run(work))
            except BaseException as error:
                outcome.set_exception(error)

        threading.Thread(target=run, name="launch").start()
        while True:
            try:
                return outcome.result()
            except KeyboardInterrupt:
                self._interrupt_soon(signal.SIGINT)

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until the end in the current event loop, like `run`."""
        with self.__lock:
            if self.__is_running:
                raise LaunchError("this LaunchService is running already; make another one")
            self.__is_running = True
        self.__return_code = 0
        self.context._set_is_shutdown(False)
        self.__loop = asyncio.get_running_loop()
        launch_logging.launch_config.announce()
        restore_signals = self._take_signals()
        self.context._set_asyncio_loop(self.__loop)
        try:
            await self._run(shutdown_when_idle)
        except asyncio.CancelledError:
            self.emit_event(Shutdown(reason="the task of the launch was cancelled"))
            await self._run(shutdown_when_idle)
            raise
        finally:
            restore_signals()
            self.context._set_asyncio_loop(None)
            self.context._reset_environment()
            self.__loop = None
            self.__is_running = False
        return self.__return_code

    async def _run(self, shutdown_when_idle: bool) -> None:
        context = self.context
        while True:
            event = context._next_event()
            if event is not None:
                self._process(event)
                continue
            failure = context._next_failure()
            if failure is not None:
                self._fail(failure)
                continue
            if not context._is_busy:
                if context.is_shutdown:
                    return
                if shutdown_when_idle:
                    self.emit_event(Shutdown(reason="idle"))
                    continue
            await context._something_happens()

    def _process(self, event: Event) -> None:
        """Offer an event to all handlers and visit the entities they return."""
        _LOG.debug(f"processing event: '{event.name}'")
        if isinstance(event, Shutdown):
            if self.context.is_shutdown:
                return
            self.context._set_is_shutdown(True)
        try:
            try:
                self.__visiting = True
                self._visit_answers(event)
            finally:
                self.__visiting = False
        except KeyboardInterrupt:
            self.context._drop_scopes()
        except Exception as error:
            self.context._drop_scopes()
            self._fail(error)
        number, self.context._held_signal = self.context._held_signal, None
        if number is not None:
            self._interrupt(number)

    def _visit_answers(self, event: Event) -> None:
        context = self.context
        if isinstance(event, IncludeLaunchDescription):
            visit(event.launch_description, context)
        for handler in context.handlers_of(event):
            try:
                self._visit_answer(handler, event)
            except KeyboardInterrupt:
                context._drop_scopes()
                if not isinstance(event, Shutdown):
                    raise

    def _visit_answer(self, handler: EventHandler, event: Event) -> None:
        context = self.context
        context._push_locals()
        context.extend_locals({"event": event})
        for entity in listed(handler.handle(event, context), f"the answer of {type(handler).__name__}"):
            visit(entity, context)
        context._pop_locals()

    def _fail(self, error: BaseException) -> None:
        self.__return_code = 1
        _LOG.debug("".join(traceback.format_exception(error)).rstrip())
        _LOG.error(f"Caught exception in launch (see debug for traceback): {sentence(error)}")
        self.emit_event(Shutdown(reason=f"Caught exception in launch: {error}"))

    # Signals

    def _take_signals(self) -> Callable[[], None]:
        """Install signal handlers in the main thread; return a function that restores the previous ones.

        Uses `signal.signal`, which also works if the parent has set SIGINT to ignored, as a shell's `&` does.
        """
        if threading.current_thread() is not threading.main_thread():
            return lambda: None
        before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGCHLD, *_OTHER_ENDS)}
        for number in (signal.SIGINT, *_OTHER_ENDS):
            signal.signal(number, self._on_signal)
        if before[signal.SIGCHLD] is signal.SIG_IGN:
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # otherwise the exit codes of children would be lost
        asleep = self._wake_on_signals()

        def restore() -> None:
            asleep()
            for number, handler in before.items():
                signal.signal(number, handler if handler is not None else signal.SIG_DFL)

        return restore

    def _wake_on_signals(self) -> Callable[[], None]:
        """Let each signal wake the loop; return a function that ends this.

        A handler runs only when the main thread computes. A signal that another thread gets, or that comes just before
        the loop begins to wait, would not be heard before the next event. Source: signal.set_wakeup_fd.
        """
        loop = self.__loop
        assert loop is not None
        reading, writing = socket.socketpair()
        reading.setblocking(False)
        writing.setblocking(False)
        before = signal.set_wakeup_fd(writing.fileno(), warn_on_full_buffer=False)
        if before != -1:  # the loop has one of its own
            signal.set_wakeup_fd(before)
        else:
            loop.add_reader(reading, reading.recv, 4096)

        def end() -> None:
            if before == -1:
                loop.remove_reader(reading)
                signal.set_wakeup_fd(-1)
            reading.close()
            writing.close()

        return end

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if self.__visiting:
            if not postponed(number, frame):
                self.context._hold_signal(number)
        else:
            self._interrupt_soon(number)

    def _interrupt_soon(self, number: int) -> None:
        loop = self.__loop
        if loop is not None:
            loop.call_soon_threadsafe(self._interrupt, number)

    def _interrupt(self, number: int) -> None:
        """End the run with exit code 0 for SIGINT, else 1."""
        if number == signal.SIGINT:
            again = " again, ignoring..." if self.context.is_shutdown else ""
            _LOG.warning(f"user interrupted with ctrl-c (SIGINT){again}")
            self.emit_event(Shutdown(reason="ctrl-c (SIGINT)", due_to_sigint=True))
            return
        self.__return_code = 1
        name = signal.Signals(number).name
        _LOG.warning(f"received {name}: shutting down")
        self.emit_event(Shutdown(reason=name))


async def _nothing() -> None:
    """Do nothing, for `await shutdown()`."""
