"""The matchers of processes, and the events that act on those they match."""

from gz_course.sim.ros.launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from gz_course.sim.ros.launch.event_handlers import OnProcessExit, OnProcessStart
from gz_course.sim.ros.launch.events import matches_action
from gz_course.sim.ros.launch.events.process import ShutdownProcess, SignalProcess, matches_name, matches_pid


def test_matchers(run):
    action = ExecuteProcess(cmd=["sh", "-c", "true"])
    run(action)
    pid = action.process_details["pid"]
    assert matches_pid(pid)(action) and not matches_pid(pid + 1)(action)
    assert matches_name("sh")(action) and matches_name("sh-1")(action) and not matches_name("s")(action)
    assert not matches_name("sh")(LogInfo(msg=""))
    assert matches_action(action)(action) and not matches_action(ExecuteProcess(cmd=["sh", "-c", "true"]))(action)


def test_a_matched_action_is_signalled(run):
    """Only the process that `matches_action` names, by SignalProcess and by ShutdownProcess."""
    first, second = (ExecuteProcess(cmd=["sleep", "1000"], name=name) for name in ("first", "second"))
    result = run(
        first,
        second,
        RegisterEventHandler(
            OnProcessStart(
                target_action=second,
                on_start=EmitEvent(event=SignalProcess(signal_number="SIGTERM", process_matcher=matches_action(first))),
            )
        ),
        RegisterEventHandler(
            OnProcessExit(
                target_action=first, on_exit=EmitEvent(event=ShutdownProcess(process_matcher=matches_action(second)))
            )
        ),
    )
    assert (result.code, first.return_code, second.return_code) == (0, -15, -2)
