"""The cells that the reader of chapter 10 writes."""

from __future__ import annotations

import ast
import math

from gz_course.grader.lessons.motion import motion_in_the_middle, motion_of
from gz_course.grader.lessons.step import COMMANDS, NotYet, Tried, expect, step

TURNED = 0.15  # [rad] that a turn may be off: the server stops within 0.05, and looks ten times a second
LONGEST = 8  # [s] of simulated time until a service has answered
NEAR, FAR = 0.2, 0.6  # [m] that a robot drives at least for 0.3 m, and by which it has passed them
STOP = "ros2 topic pub --once /cmd_vel geometry_msgs/msg/Twist '{}'"
DRIVE = {
    "goal": {"legs": "sequence<double>", "speed": "double"},
    "result": {"driven": "int32"},
    "feedback": {"leg": "int32", "left": "double"},
}
PACKAGE = "drive_ws/src/turn_interfaces"


@step("faster", objective=2, form=COMMANDS)
def faster(tried: Tried) -> str:
    """The robot circles at 0.3 m/s."""
    moves = motion_in_the_middle(tried)
    expect(abs(moves.speed - 0.3) < 0.03, f"The robot {moves}; 0.3 m/s is wanted, by the parameter of its node.")
    return f"The robot {moves}."


@step("switch_off", objective=1, form=COMMANDS)
def switch_off(tried: Tried) -> str:
    """The robot stands, because its node was told to by the service /drive."""
    moves = motion_in_the_middle(tried)
    expect(moves.stands, f"The robot {moves}; 0 m/s is wanted, and the node says so ten times a second once it is off.")
    return "The robot stands, and its node keeps it there."


@step("drive_action", objective=3, form="Drive.action")
def drive_action(tried: Tried) -> str:
    """Drive.action has the goal, the result and the feedback that are asked for, and builds."""
    built = tried.command(
        "rm -rf drive_ws && mkdir -p drive_ws/src && cp -r turn_ws/src/turn_interfaces drive_ws/src"
        f" && mv Drive.action {PACKAGE}/action && sed -i s/Turn.action/Drive.action/ {PACKAGE}/CMakeLists.txt"
        " && cd drive_ws && colcon build 2>&1 || echo IT DOES NOT BUILD",
        deadline=40.0,
    )
    if "IT DOES NOT BUILD" in built:
        said = [line.strip() for line in built.splitlines() if "Drive.action" in line or "rror" in line]
        raise NotYet(f"The package with your action does not build: {said[0] if said else 'colcon has an error'}")
    found = ast.literal_eval(
        tried.command(
            "AMENT_PREFIX_PATH=$PWD/drive_ws/install/turn_interfaces python -c '"
            "from turn_interfaces.action import Drive as D\n"
            "print({k.__name__.lower(): dict(k.get_fields_and_field_types()) for k in (D.Goal, D.Result, D.Feedback)})'"
        ).splitlines()[-1]
    )
    tried.command("rm -rf drive_ws")
    fields = {part.rpartition("_")[2]: kinds for part, kinds in found.items()}
    for part, wanted in DRIVE.items():
        for name, kind in wanted.items():
            there = fields[part].get(name)
            expect(there is not None, f"A field {name} is missing in the {part}; it has {_listed(fields[part])}.")
            expect(there == kind, f"The field {name} of the {part} is built as {there}; {kind} is wanted.")
    return "The action builds: goal, result and feedback have the fields that are asked for."


def _listed(fields: dict[str, str]) -> str:
    return ", ".join(fields) or "none"


@step("two_at_once", objective=5, form="ahead.py")
def two_at_once(tried: Tried) -> str:
    """The service /ahead drives 0.3 m, and answers."""
    tried.start("python ahead.py --ros-args -p use_sim_time:=true", ready="ready")
    tried.place("robot", -1.0, 0.0)
    begin = tried.poses("robot")[-1]
    tried.start("ros2 service call /ahead std_srvs/srv/Trigger", ready="making request")
    for _ in range(LONGEST):
        moves = tried.poses("robot", 1.0)
        end = moves[-1]
        gone, speed = math.hypot(end.x - begin.x, end.y - begin.y), motion_of(moves).speed
        if gone > FAR or (gone > NEAR and speed < 0.02):
            tried.poses("robot", 1.0)  # in which the answer is printed
            break
    answer = tried.stop("ros2 service call")
    tried.stop("python ahead.py")
    tried.command(STOP)
    expect("response" in answer, f"The robot drove {gone:z.1f} m, and no answer came: on_odometry waits for on_ahead.")
    expect(NEAR < gone < FAR, f"The service has answered, and the robot drove {gone:z.2f} m; 0.3 m is wanted.")
    return f"The robot drove {gone:z.2f} m and the service answered: odometry came while it waited."


@step("angle_to", objective=4)
def angle_to(tried: Tried) -> str:
    """angle_to(...) is the angle by which a robot turns to face a place."""
    function = tried.function("angle_to")
    for x, y, heading, east, north in ((0, 0, 0, 1, 1), (1, 2, 0.5, 1, 3), (0, 1, 1.2, -1, 1), (0, 0, -3.0, -1, 0.3)):
        said = function(float(x), float(y), heading, float(east), float(north))
        expect(isinstance(said, float | int), f"angle_to returns a {type(said).__name__}; a number is wanted.")
        wanted = math.remainder(math.atan2(north - y, east - x) - heading, math.tau)
        where = f"From ({x}, {y}) with the heading {heading} to ({east}, {north})"
        off = abs(math.remainder(said - wanted, math.tau))
        expect(off < 1e-3, f"{where} it says {said:z.2f} rad; {wanted:z.2f} is wanted.")
        expect(abs(said) < 3.15, f"{where} it says {said:z.2f} rad; an angle between -pi and pi is wanted.")
    tried.place("robot", 0.0, 0.0, -0.8)
    begin = tried.poses("robot")[-1]
    angle = function(begin.x, begin.y, begin.yaw, 1.0, 2.0)
    goal = f"'{{angle: {angle:z.3f}}}'"
    tried.command(f"timeout 15 ros2 action send_goal /turn turn_interfaces/action/Turn {goal} || true")
    end = tried.poses("robot")[-1]
    faces = math.atan2(2.0 - end.y, 1.0 - end.x)
    off = abs(math.remainder(end.yaw - faces, math.tau))
    expect(off < TURNED, f"After the turn the robot looks {off:z.2f} rad past the place. Does turn_server.py run?")
    return f"The robot turned by {angle:z.2f} rad, and faces the place."
