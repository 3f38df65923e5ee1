"""Event handlers: which events they get, and when an action is complete."""

from gz_course.sim.ros.launch import Event, EventHandler, LaunchContext, LaunchDescription
from gz_course.sim.ros.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    TimerAction,
    UnregisterEventHandler,
)
from gz_course.sim.ros.launch.event_handlers import OnExecutionComplete, OnIncludeLaunchDescription, event_named
from gz_course.sim.ros.launch.events import IncludeLaunchDescription


def said(result):
    return [line.removeprefix("[INFO] [launch.user]: ") for line in result.lines if "[launch.user]" in line]


def note(*text):
    return LogInfo(msg=[*text])


def test_handlers_come_and_go(run):
    action = note("a")
    handler = OnExecutionComplete(target_action=action, on_completion=[note("done")])
    assert said(run(RegisterEventHandler(handler), action)) == ["a", "done"]
    once = OnExecutionComplete(
        target_action=lambda each: isinstance(each, OpaqueFunction), on_completion=[note("once")], handle_once=True
    )
    calls = [OpaqueFunction(function=lambda context: None) for _ in range(2)]
    assert said(run(RegisterEventHandler(once), *calls)) == ["once"]
    result = run(RegisterEventHandler(handler), UnregisterEventHandler(handler), UnregisterEventHandler(handler))
    assert result.code == 1 and "is not registered" in result.text


def test_the_end_of_a_process_completes_its_action(run):
    action = ExecuteProcess(cmd=["true"])
    handler = OnExecutionComplete(target_action=action, on_completion=[note("completed")])
    result = run(RegisterEventHandler(handler), action)
    assert result.lines[-1] == "[INFO] [launch.user]: completed"


def test_a_timer_is_complete_after_its_actions_and_only_for_handlers_that_were_there(run):
    def timer_with(text):
        timer = TimerAction(period=0.0, actions=[note("due")])
        handler = OnExecutionComplete(target_action=timer, on_completion=[note(text)])
        return timer, RegisterEventHandler(handler)

    timer, registered = timer_with("after it")
    assert said(run(registered, timer)) == ["due", "after it"]
    timer, registered = timer_with("never")
    assert said(run(timer, registered)) == ["due"]


def test_events_are_found_by_their_names(run):
    class Arrived(Event):
        name = "my_package.Arrived"

    def on(name):
        return RegisterEventHandler(EventHandler(matcher=event_named(name), entities=note(name)))

    result = run(on(Arrived.name), on("launch.events.Shutdown"), on("Shutdown"), EmitEvent(event=Arrived()))
    assert said(result) == ["my_package.Arrived", "launch.events.Shutdown"]


def test_a_launch_description_of_an_event_is_visited(run):
    description = LaunchDescription([note("included")])
    event, handler = IncludeLaunchDescription(description), OnIncludeLaunchDescription()
    assert said(run(EmitEvent(event=event))) == ["included"], "a LaunchService has such a handler"
    assert handler.matches(event) and not handler.matches(Event())
    assert handler.handle(event, LaunchContext()) == [description]
