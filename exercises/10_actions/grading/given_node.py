"""The dispatcher: sends goals to the action /patrol, and reports to the grader what became of them.

Its orders say which goals: `patrol` has `waypoints` [m] and `speed` [m/s], `too_fast` is above the largest speed [m/s],
`cancelled` is a patrol that is cancelled `after` some time [s], `again` is a patrol after that. Each report has its
number, an `event`, the name of the `goal`, and what belongs to it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rclpy
from action_msgs.msg import GoalStatus
from course_agent.exercise_node import orders, ready, report
from geometry_msgs.msg import Point
from rclpy.action import ActionClient
from rclpy.node import Node

FIELDS = {
    "Goal": {"waypoints": "sequence<geometry_msgs/Point>", "speed": "double"},
    "Result": {"visited": "int32"},
    "Feedback": {"waypoint": "int32", "distance": "double"},
}
STATUS = {
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}
BUSY_AFTER = 1.0  # [s] after a goal was accepted, another one is sent
TO_BE_REJECTED = ("empty", "too_fast", "backwards", "standing", "second")


def interface_fault() -> tuple[Any, str]:
    """Return the action's class and what is wrong with it: one of them is empty."""
    try:
        from patrol_interfaces.action import Patrol
    except ImportError as error:
        return None, str(error)
    fields = {part: getattr(Patrol, part).get_fields_and_field_types() for part in FIELDS}
    if fields["Result"].keys() >= FIELDS["Feedback"].keys() and fields["Feedback"].keys() >= FIELDS["Result"].keys():
        return None, (
            "the second part of Patrol.action holds the feedback and the third the result; the order of the parts is "
            "goal, result, feedback"
        )
    for part, wanted in FIELDS.items():
        found = fields[part]
        for name, kind in wanted.items():
            if found.get(name) != kind:
                seen = f"{name} of type {found[name]}" if name in found else f"{', '.join(found) or 'no field'}"
                return None, f"the {part.lower()} of Patrol.action has {seen}, not {name} of type {kind}"
    return Patrol, ""


class Dispatcher(Node):
    """Sends one goal after another; an answer, or a time, brings the next."""

    def __init__(self, script: dict[str, Any]) -> None:
        super().__init__("dispatcher")
        self.script = script
        self.number = 0
        self.waits: list[Any] = []
        self.action, fault = interface_fault()
        if fault:
            self.after(0.2, lambda: self.say("interface", "", fault=fault))
            return
        self.client = ActionClient(self, self.action, "/patrol")
        self.after(0.5, self.begin)

    def begin(self) -> None:
        self.say("interface", "", fault="")
        patrol = self.script["patrol"]
        if not self.client.wait_for_server(timeout_sec=0.0):  # not of the run's time, but until discovery is done
            self.say("no_server", "")
            return
        self.send("empty", [], patrol["speed"])
        self.send("too_fast", patrol["waypoints"], self.script["too_fast"])
        self.send("backwards", patrol["waypoints"], -0.2)
        self.send("standing", patrol["waypoints"], 0.0)
        self.after(0.5, lambda: self.send("patrol", **patrol))

    def after(self, seconds: float, call: Callable[[], None]) -> None:
        """Call something once."""

        def once() -> None:
            timer.cancel()
            call()

        timer: Any = self.create_timer(seconds, once)
        self.waits.append(timer)

    def say(self, event: str, goal: str, **more: Any) -> None:
        self.number += 1
        report(number=self.number, event=event, goal=goal, **more)

    def send(self, name: str, waypoints: list[list[float]], speed: float) -> None:
        points = [Point(x=float(x), y=float(y)) for x, y in waypoints]
        goal = self.action.Goal(waypoints=points, speed=float(speed))
        self.say("sent", name, waypoints=waypoints, speed=speed)

        def feedback(message: Any) -> Any:
            said = message.feedback
            self.say("feedback", name, waypoint=said.waypoint, distance=said.distance)

        def answered(future: Any) -> None:
            handle = future.result()
            self.say("accepted" if handle.accepted else "rejected", name)
            if handle.accepted:
                handle.get_result_async().add_done_callback(done)
                self.accepted(name, handle)
            elif name == "patrol":
                self.next_of(name)

        def done(future: Any) -> None:
            result = future.result()
            status = STATUS.get(result.status, str(result.status))
            self.say("result", name, status=status, visited=result.result.visited)
            self.next_of(name)

        self.client.send_goal_async(goal, feedback).add_done_callback(answered)

    def accepted(self, name: str, handle: Any) -> None:
        if name in TO_BE_REJECTED:  # it must not spoil the rest
            handle.cancel_goal_async()
        if name == "patrol":
            self.after(BUSY_AFTER, lambda: self.send("second", [self.script["again"]["waypoints"][0]], 0.2))
        if name == "cancelled":
            self.after(self.script["cancelled"]["after"], lambda: self.cancel(name, handle))

    def cancel(self, name: str, handle: Any) -> None:
        self.say("cancel", name)

        def answered(future: Any) -> Any:
            self.say("cancelling" if future.result().goals_canceling else "not_cancelling", name)

        handle.cancel_goal_async().add_done_callback(answered)

    def next_of(self, name: str) -> Any:
        if name == "patrol":
            goal = self.script["cancelled"]
            self.after(0.5, lambda: self.send("cancelled", goal["waypoints"], goal["speed"]))
        if name == "cancelled":
            self.after(1.0, lambda: self.send("again", **self.script["again"]))


def main() -> None:
    rclpy.init()
    node = Dispatcher(orders())
    ready()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
