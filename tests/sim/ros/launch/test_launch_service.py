"""LaunchService: its end, its exit code, threads, loops, many runs, handlers, scopes, timers."""

import asyncio
import os
import signal
import threading

import pytest

import gz_course.sim.ros.launch.events as launch_events
from gz_course.sim.ros.launch import LaunchDescription, LaunchService, event_handlers
from gz_course.sim.ros.launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    RegisterEventHandler,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from gz_course.sim.ros.launch.conditions import (
    IfCondition,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
)
from gz_course.sim.ros.launch.event_handlers import (
    OnProcessExit,
    OnProcessIO,
    OnShutdown,
)
from gz_course.sim.ros.launch.substitutions import EnvironmentVariable, LaunchConfiguration, PythonExpression


def said(result):
    return [line.removeprefix("[INFO] [launch.user]: ") for line in result.lines if "[launch.user]" in line]


def note(*text):
    return LogInfo(msg=[*text])


def description(*entities):
    return LaunchDescription(list(entities))


def started(*entities):
    service = LaunchService()
    service.include_launch_description(description(*entities))
    return service


def test_it_ends_when_there_is_nothing_more_to_do(run):
    assert run(note("a")).code == 0


def test_it_can_wait_for_a_shutdown():
    service = started()
    service.context.register_event_handler(OnShutdown(on_shutdown=[]))
    timer = threading.Timer(0.05, service.shutdown)
    timer.start()
    assert service.run(shutdown_when_idle=False) == 0
    timer.join()
    assert timer.finished.is_set()


def test_an_exception_ends_it_and_nothing_else_starts(run):
    def fail(context):
        raise ValueError("that was wrong")

    result = run(ExecuteProcess(cmd=["echo"]), OpaqueFunction(function=fail), note("not reached"))
    assert result.code == 1
    assert result.lines == [
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
        f"{__file__}:{fail.__code__.co_firstlineno + 1}: ValueError: that was wrong"
    ]


def test_debug_shows_the_traceback(capsys):
    service = LaunchService(debug=True)
    service.include_launch_description(description(OpaqueFunction(function=lambda context: 1 / 0)))
    assert service.run() == 1
    text = capsys.readouterr().out
    assert "[DEBUG] [launch]: Traceback" in text and "ZeroDivisionError" in text


def test_an_exception_in_an_answer_ends_the_processes_that_run(run):
    timer = TimerAction(period=0.05, actions=[OpaqueFunction(function=lambda context: [].pop())])
    result = run(ExecuteProcess(cmd=["sleep", "1000"]), timer)
    assert result.code == 1
    assert any("process has died" in line for line in result.lines)


async def failing_coroutine(context):
    raise ValueError("that was wrong")


@pytest.mark.parametrize(
    "entity",
    [
        OpaqueCoroutine(coroutine=failing_coroutine),
        RegisterEventHandler(OnProcessExit(target_action=lambda action: 1 / 0, on_exit=[])),
        RegisterEventHandler(OnProcessIO(target_action=lambda action: 1 / 0, on_stdout=print)),
        RegisterEventHandler(OnProcessIO(on_stdout=lambda event: 1 / 0)),
    ],
    ids=["coroutine", "matcher of ends", "matcher of output", "answer to output"],
)
def test_an_exception_anywhere_ends_it(run, caplog, entity):
    result = run(entity, ExecuteProcess(cmd=["echo", "up"]))
    assert result.code == 1
    assert caplog.records == [], "the event loop has nothing to complain of"


def test_it_runs_in_any_thread(capsys):
    codes = []
    service = started(ExecuteProcess(cmd=["sh", "-c", "exit 3"]), note("a"))
    thread = threading.Thread(target=lambda: codes.append(service.run()))
    thread.start()
    thread.join(120)
    assert codes == [0]
    assert "exit code 3" in capsys.readouterr().out


def test_it_runs_where_a_loop_is_running_as_in_a_notebook():
    async def cell():
        inner = started(ExecuteProcess(cmd=["true"]))
        outer = started(ExecuteProcess(cmd=["true"]))
        return inner.run(), await outer.run_async()

    assert asyncio.run(cell()) == (0, 0)


def test_cancelling_its_task_ends_its_processes():
    action = ExecuteProcess(cmd=["sleep", "1000"])

    async def cell():
        up = asyncio.Event()
        service = started(action)
        service.context.register_event_handler(event_handlers.OnProcessStart(on_start=lambda event, context: up.set()))
        task = asyncio.create_task(service.run_async())
        await asyncio.wait_for(up.wait(), 30)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(cell())
    assert action.return_code == -signal.SIGINT


def test_many_runs_in_one_process_do_not_know_of_each_other(capsys, monkeypatch):
    monkeypatch.setenv("COURSE_TEST_PATH", "/a")
    handler = signal.getsignal(signal.SIGINT)
    for _ in range(3):
        service = started(
            DeclareLaunchArgument("x", default_value="1"),
            AppendEnvironmentVariable("COURSE_TEST_PATH", "/b"),
            ExecuteProcess(cmd=["printenv", "COURSE_TEST_PATH"], output="screen"),
            note(LaunchConfiguration("x")),
        )
        assert service.run() == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines.count("[printenv-1] /a:/b") == 3
    assert os.environ["COURSE_TEST_PATH"] == "/a"
    assert signal.getsignal(signal.SIGINT) is handler


def test_a_loop_that_ends_takes_the_processes_along():
    action = ExecuteProcess(cmd=["sleep", "1000"])

    async def cell():
        up = asyncio.Event()
        service = started(action)
        service.context.register_event_handler(event_handlers.OnProcessStart(on_start=lambda event, context: up.set()))
        task = asyncio.create_task(service.run_async())
        await asyncio.wait_for(up.wait(), 30)
        return task

    asyncio.run(cell())
    with pytest.raises(ProcessLookupError):
        os.killpg(action.process_details["pid"], 0)


def test_a_failure_leaves_the_scopes_it_was_in(run):
    inner = [SetLaunchConfiguration("where", "inside"), OpaqueFunction(function=lambda context: 1 / 0)]
    at_end = OnShutdown(on_shutdown=[note(LaunchConfiguration("where"))])
    result = run(RegisterEventHandler(at_end), SetLaunchConfiguration("where", "outside"), GroupAction(inner))
    assert (result.code, said(result)) == (1, ["outside"])


def test_a_failure_does_not_stay():
    service = started(OpaqueFunction(function=lambda context: 1 / 0))
    assert service.run() == 1
    service.include_launch_description(description(note("better")))
    assert service.run() == 0


def test_one_service_runs_again_but_not_twice_at_once():
    service = started(note("a"))
    assert service.run() == 0
    service.include_launch_description(description(OpaqueFunction(function=lambda context: service.run())))
    assert service.run() == 1


def test_shutdown_handlers_are_asked_once_the_newest_first(run):
    result = run(
        RegisterEventHandler(OnShutdown(on_shutdown=[note("older")])),
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: [note("newer: ", event.reason)])),
        Shutdown(reason="enough"),
        EmitEvent(event=launch_events.Shutdown(reason="again")),
    )
    assert said(result) == ["newer: enough", "older"]


def test_conditions(run):
    result = run(
        LogInfo(msg="if", condition=IfCondition(LaunchConfiguration("yes"))),
        LogInfo(msg="not if", condition=IfCondition("0")),
        LogInfo(msg="unless", condition=UnlessCondition(PythonExpression("1 > 2"))),
        LogInfo(msg="not unless", condition=UnlessCondition("1")),
        LogInfo(msg="equal", condition=LaunchConfigurationEquals("yes", "True")),
        LogInfo(msg="unset", condition=LaunchConfigurationEquals("nothing", None)),
        LogInfo(msg="different", condition=LaunchConfigurationNotEquals("yes", "true")),
        LogInfo(msg="not different", condition=LaunchConfigurationNotEquals("yes", "True")),
        arguments={"yes": "True"},
    )
    assert said(result) == ["if", "unless", "equal", "unset", "different"]
    result = run(LogInfo(msg="a", condition=IfCondition("maybe")))
    assert result.code == 1
    assert "invalid condition expression: 'maybe'; true, false, 1 or 0 is expected" in result.lines[-1]


def show(*names):
    return OpaqueFunction(
        function=lambda context: note(
            " ".join(f"{n}={context.launch_configurations.get(n) or os.environ.get(n)}" for n in names)
        )
    )


def test_a_group_is_a_scope(run):
    inside = [
        SetLaunchConfiguration("x", "2"),
        SetEnvironmentVariable("COURSE_TEST_A", "b"),
        show("x", "COURSE_TEST_A"),
    ]
    for scoped, after in ((True, "x=1 COURSE_TEST_A=None"), (False, "x=2 COURSE_TEST_A=b")):
        result = run(GroupAction([*inside], scoped=scoped), show("x", "COURSE_TEST_A"), arguments={"x": "1"})
        assert said(result) == ["x=2 COURSE_TEST_A=b", after]


def test_a_group_may_hide_the_outside(run):
    result = run(
        SetEnvironmentVariable("COURSE_TEST_A", "b"),
        GroupAction(
            [show("x", "y", "COURSE_TEST_A")], forwarding=False, launch_configurations={"y": LaunchConfiguration("x")}
        ),
        GroupAction([show("x", "z")], launch_configurations={"z": "3"}),
        show("x", "y", "z"),
        arguments={"x": "1"},
    )
    assert said(result) == ["x=None y=1 COURSE_TEST_A=None", "x=1 z=3", "x=1 y=None z=None"]


def test_a_group_has_a_condition(run):
    assert said(run(GroupAction([note("a")], condition=IfCondition("false")), note("b"))) == ["b"]


def test_scopes_by_hand(run):
    result = run(
        PushLaunchConfigurations(),
        PushEnvironment(),
        SetLaunchConfiguration("x", "2"),
        UnsetLaunchConfiguration("y"),
        SetEnvironmentVariable("COURSE_TEST_A", "b"),
        AppendEnvironmentVariable("COURSE_TEST_A", "a", prepend=True, separator="+"),
        show("x", "y", "COURSE_TEST_A"),
        UnsetEnvironmentVariable("COURSE_TEST_A"),
        ResetLaunchConfigurations({"z": LaunchConfiguration("x")}),
        show("x", "z", "COURSE_TEST_A"),
        PopEnvironment(),
        PopLaunchConfigurations(),
        show("x", "y", "z"),
        arguments={"x": "1", "y": "1"},
    )
    assert said(result) == [
        "x=2 y=None COURSE_TEST_A=a+b",
        "x=None z=2 COURSE_TEST_A=None",
        "x=1 y=1 z=None",
    ]
    assert "without a PushEnvironment" in run(PopEnvironment()).text
    assert "without a PushLaunchConfigurations" in run(PopLaunchConfigurations()).text


def test_children_see_the_environment_of_their_scope(run, monkeypatch):
    monkeypatch.setenv("COURSE_TEST_A", "outside")
    printing = ExecuteProcess(cmd=["printenv", "COURSE_TEST_A"], output="screen")
    result = run(
        GroupAction([SetEnvironmentVariable("COURSE_TEST_A", "inside"), printing]),
        note(EnvironmentVariable("COURSE_TEST_A")),
    )
    assert result.printed_by("printenv") == ["inside"]
    assert said(result) == ["outside"]


def test_timers(run):
    cancelled = TimerAction(period=1000.0, actions=[note("never")])
    result = run(
        TimerAction(period=LaunchConfiguration("t"), actions=[note("second")]),
        TimerAction(period=0, actions=[note("first"), OpaqueFunction(function=lambda context: cancelled.cancel())]),
        cancelled,
        arguments={"t": "0.1"},
    )
    assert said(result) == ["first", "second"]
    assert result.code == 0


def test_a_shutdown_cancels_timers(run):
    assert said(run(TimerAction(period=1000.0, actions=[note("never")]), Shutdown())) == []
    result = run(TimerAction(period=0.02, actions=[note("late")], cancel_on_shutdown=False), Shutdown())
    assert said(result) == ["late"]


@pytest.mark.parametrize("period", ["soon", "", "nan"])
def test_a_period_that_is_no_time(run, period):
    result = run(TimerAction(period=period, actions=[]))
    assert result.code == 1 and "is no number of seconds" in result.text


def test_functions_and_coroutines(run):
    def several(context, *texts, last):
        return [note(text) for text in (*texts, last)]

    async def work(context, text):
        await context.emit_event(launch_events.Shutdown(reason=text))

    result = run(
        OpaqueFunction(function=several, args=["a", LaunchConfiguration("x").describe()], kwargs={"last": "c"}),
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: note(event.reason))),
        OpaqueCoroutine(coroutine=work, args=["worked"]),
    )
    assert said(result) == ["a", "LaunchConfig('x')", "c", "worked"]
    result = run(OpaqueFunction(function=lambda context: ["a"]))
    assert "returned holds 'a' of type str; only actions can stand there" in result.text


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: LaunchDescription(note("a")), "the brackets are missing"),
        (lambda: LaunchDescription(["a"]), "holds 'a' of type str"),
        (lambda: RegisterEventHandler(note("a")), "wants an event handler such as OnProcessExit"),
        (lambda: EmitEvent(event=Shutdown()), "launch.events.Shutdown\\(\\) is one"),
        (lambda: OpaqueFunction(function=3), "cannot be called"),
        (lambda: OpaqueCoroutine(coroutine=print), "async def"),
        (lambda: OnProcessExit(target_action="talker", on_exit=[]), "of type str; ExecuteLocal, a function or None"),
        (lambda: OnProcessExit(target_action=note("a"), on_exit=[]), "of type LogInfo"),
        (
            lambda: LogInfo(msg="a", condtion=IfCondition("1")),
            "LogInfo has no argument 'condtion'; did you mean 'condi",
        ),
    ],
)
def test_arguments_that_make_no_sense(make, words):
    with pytest.raises(Exception, match=words):
        make()
