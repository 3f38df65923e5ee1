"""What a cell did, asked of what runs: the ROS graph, Gazebo's topics, the true poses of the world, commands.

It uses contexts of ROS of its own, so that a cell may initialise and shut down rclpy as it likes.
"""

from __future__ import annotations

import functools
import importlib
import math
import re
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.lessons.cell import own_words, run_commands
from gz_course.grader.lessons.observer import SEEN, SpinUntil, both_ways, named, observer, until_found
from gz_course.grader.lessons.step import NotYet, Pose, Tried
from gz_course.grader.process.load import crowded

if TYPE_CHECKING:
    from gz_course.grader.tools.playground import Playground, Program

OF_EVERY_NODE = {"/rosout", "/parameter_events"}
OF_ROS2_RUN = "[ros2run]"
FAULT = re.compile(r"^\[(?:WARN|ERROR)\] \[[\d.]+\] \[(\S+)\]: (.+)$", re.MULTILINE)
POSES = "/dynamic_pose/info"
ROUNDS = 3  # of waiting for messages, as long as some come in each
TRIES = 2  # a single message may be lost while two nodes find each other
STARTED = 12.0  # [s] from the start of a command until its node is found
READY = 30.0  # [s] until a command says what it is waited for


class RunningWorld(Tried):
    """What a cell did in the playground of its notebook."""

    def __init__(self, room: Playground, cell: tuple[str, str, str], names: dict[str, Any], folder: Path) -> None:
        """`cell`: the name of its step, its text, and what it printed; `names`: the notebook's."""
        step, self.body, self.output = cell
        self._room, self._names, self.folder = room, names, folder
        self._file = f"<step {step}>"
        self._started_here: list[Program] = []

    def value(self, name: str, kind: type | tuple[type, ...] = object) -> Any:
        if name not in self._names or self._names[name] is ...:
            raise NotYet(f"There is no `{name}` yet.")
        value = self._names[name]
        kinds = kind if isinstance(kind, tuple) else (kind,)
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds and object not in kinds):
            wanted = " or ".join(each.__name__ for each in kinds)
            raise NotYet(f"`{name}` is of type {type(value).__name__}; {wanted} is wanted.")
        return value

    def function(self, name: str) -> Callable[..., Any]:
        found = self._names.get(name)
        if not callable(found):
            raise NotYet(f"There is no function `{name}` yet.")

        @functools.wraps(found)
        def called(*arguments: Any, **named: Any) -> Any:
            with own_words(self._file):
                return found(*arguments, **named)

        return called

    def command(self, command: str, deadline: float = 20.0) -> str:
        return run_commands(command, self.folder, deadline)

    def start(self, command: str, ready: str) -> str:
        return self._started(command, ready).output

    def _started(self, command: str, ready: str) -> Program:
        self._open()
        program = self._room.start(command, instead_of=" ".join(command.split()[:4]))
        try:
            program.wait_for(ready, READY)
        except TimeoutError:
            state = "runs" if program.exit_code is None else "has ended"
            said = _last_line(program.output)
            program.stop()
            last = f"; its last line is: {said}" if said else " and has printed nothing"
            raise NotYet(f"`{command}` {state}{last}") from None
        self._started_here.append(program)
        return program

    def stop(self, command: str) -> str:
        programs = [program for program in self._room.programs if program.command.startswith(command)]
        ended = {program for program in programs[:-1] if program.exit_code is not None}  # of attempts before
        output = ""
        for program in programs:
            if program not in ended:
                program.stop()
                output += program.output
        return output

    def heard(self, topic: str, message_type: str, count: int = 1, deadline: float = 10.0) -> list[Any]:
        found = self._listen(topic, message_type, count, deadline)
        if len(found) < count:
            came = f"only {len(found)} of {count} messages came" if found else "no message came"
            faults = (_fault(program.output) for program in self._started_here)
            why = next(filter(None, faults), "Does what publishes there run?")
            raise NotYet(f"On {topic} {came}. {why}")
        return found

    def heard_from(
        self, command: str, topic: str, message_type: str, count: int = 1, after: float = 2.0, deadline: float = 8.0
    ) -> list[Any]:
        for _ in range(TRIES):
            found, code, said = self._answers(command, topic, message_type, (count, after, deadline))
            last = f" Its last line is: {said}" if said else ""
            if code:
                raise NotYet(f"`{command}` ended with exit code {code}.{last}")
            if found:
                return found[:count]
        raise NotYet(f"`{command}` was started, and no message came on {topic}.{last}")

    def _answers(
        self, command: str, topic: str, message_type: str, wait: tuple[int, float, float]
    ) -> tuple[list[Any], int | None, str]:
        """Return the messages that come once a command is started, its exit code, and what it said last."""
        count, after, deadline = wait
        found: list[Any] = []
        with self.node() as (node, spin_until):
            node.create_subscription(_message(message_type), topic, found.append, _sensor_qos())
            program = self._room.start(command)

            def came() -> bool:
                return bool(found) or program.exit_code is not None

            spin_until(lambda: came() or node.count_publishers(topic) > 0, STARTED)
            spin_until(came, deadline)
            if found:
                spin_until(lambda: len(found) >= count, after)
            code = program.exit_code
            program.stop()
        return found, code, _last_line(program.output)

    def time(self, stamp: Any) -> Any:
        from rclpy.clock import ClockType
        from rclpy.time import Time

        return Time.from_msg(stamp, clock_type=ClockType.ROS_TIME)

    def silent(self, topic: str, message_type: str, seconds: float) -> bool:
        return not self._listen(topic, message_type, 1, seconds)

    def _listen(self, topic: str, message_type: str, count: int, deadline: float) -> list[Any]:
        found: list[Any] = []
        with self.node() as (node, spin_until):
            node.create_subscription(_message(message_type), topic, found.append, _sensor_qos())
            until_found(node, spin_until, lambda: bool(found) or node.count_publishers(topic) > 0)
            if found or node.count_publishers(topic):
                rounds, before = 0, -1
                while before < len(found) < count and (rounds < ROUNDS or crowded()):  # a slow world goes on
                    rounds, before = rounds + 1, len(found)
                    spin_until(lambda: len(found) >= count, deadline)
        return found[:count]

    def topics(self, *wanted: str) -> dict[str, list[str]]:
        with self.node() as (node, spin_until):

            def known() -> dict[str, list[str]]:
                return {name: types for name, types in node.get_topic_names_and_types() if name not in OF_EVERY_NODE}

            until_found(node, spin_until, lambda: bool(wanted) and known().keys() >= set(wanted))
            return known()

    def publishers(self, topic: str) -> list[str]:
        with self.node() as (node, spin_until):
            until_found(node, spin_until, lambda: named(node.get_publishers_info_by_topic(topic)))
            return sorted(each.node_name for each in node.get_publishers_info_by_topic(topic))

    def subscribers(self, topic: str) -> list[str]:
        with self.node() as (node, spin_until):
            until_found(node, spin_until, lambda: named(node.get_subscriptions_info_by_topic(topic)))
            return sorted(each.node_name for each in node.get_subscriptions_info_by_topic(topic))

    def both_ways(self, topic: str, message_type: str = "") -> list[str]:
        with self.node() as (node, spin_until):
            if message_type:
                node.create_subscription(_message(message_type), topic, lambda _: None, _sensor_qos())
            return sorted(both_ways(node, spin_until, topic))

    def transform(self, target: str, source: str) -> Any:
        from rclpy.time import Time

        from gz_course.sim.ros import tf2_ros

        with self.node() as (node, spin_until):
            buffer = tf2_ros.Buffer()
            listener = tf2_ros.TransformListener(buffer, node)
            until_found(node, spin_until, lambda: bool(buffer.can_transform(target, source, Time())))
            try:
                return buffer.lookup_transform(target, source, Time())
            except tf2_ros.TransformException:
                raise NotYet(f"tf2 finds no way from `{source}` to `{target}`.") from None
            finally:
                del listener

    def gz_topics(self, wanted: str = "") -> list[str]:
        return self._gz_topics(lambda topic: not wanted or topic == wanted)

    def _gz_topics(self, wanted: Callable[[str], bool]) -> list[str]:
        from gz_course.sim.gz.transport.node import Node

        self._open()
        with Node() as node:
            end = time.monotonic() + SEEN
            found = node.topic_list()
            while not any(map(wanted, found)) and time.monotonic() < end:
                found = node.topic_list()  # asks the network, and waits for its answers
        return sorted(found)

    def poses(self, model: str, seconds: float = 0.0) -> list[Pose]:
        return _poses(f"/world/{self._world()}{POSES}", model, seconds)

    def place(self, model: str, x: float, y: float, yaw: float = 0.0) -> None:
        z = self.poses(model)[-1].z
        turn = f"orientation: {{z: {math.sin(yaw / 2)}, w: {math.cos(yaw / 2)}}}"
        request = f'name: "{model}", position: {{x: {x}, y: {y}, z: {z}}}, {turn}'
        types = "--reqtype gz.msgs.Pose --reptype gz.msgs.Boolean --timeout 5000"
        self.command(f"gz service -s /world/{self._world()}/set_pose {types} --req '{request}'")

    def remove(self, model: str) -> None:
        types = "--reqtype gz.msgs.Entity --reptype gz.msgs.Boolean --timeout 5000"
        self.command(f"gz service -s /world/{self._world()}/remove {types} --req 'name: \"{model}\", type: MODEL'")

    def _world(self) -> str:
        def of_world(topic: str) -> bool:
            return topic.startswith("/world/") and topic.endswith(POSES)

        for topic in self._gz_topics(of_world):
            if of_world(topic):
                return topic.removeprefix("/world/").removesuffix(POSES)
        raise NotYet("No world runs; run the cell that starts `gz sim`.")

    def message_type(self, name: str) -> Any:
        """Return the class of messages of a type, such as `std_msgs/msg/String`."""
        return _message(name)

    def recording(self) -> Any:
        from gz_course.grader.record.reading import Recording

        chapter = self.folder.name
        path = self.folder.parents[1] / "runs" / chapter / f"{chapter}.rrd"
        if not path.is_file():
            raise NotYet(f"There is no recording yet; run the cell with `course grade {chapter}`.")
        return Recording(path)

    def _open(self) -> None:
        if self._room.closed:
            raise NotYet("The playground is closed; run the chapter's cells from the one that makes `room`.")

    def node(self) -> AbstractContextManager[tuple[Any, SpinUntil]]:
        self._open()
        return observer()


def _last_line(output: str) -> str:
    """Return what a program said last; not what `ros2 run` says of its end."""
    said = [line for line in output.splitlines() if line.strip() and not line.startswith(OF_ROS2_RUN)]
    return said[-1] if said else ""


def _fault(output: str) -> str:
    """Return the first error that a ROS program has logged, as a sentence; empty if there is none."""
    found = FAULT.search(output)
    return f"{found[1]} says: {found[2].rstrip('.')}." if found else ""


def _sensor_qos() -> Any:
    """Return the quality of service that connects with every publisher."""
    from rclpy.qos import qos_profile_sensor_data

    return qos_profile_sensor_data


def _message(name: str) -> Any:
    package, _, kind = name.partition("/msg/")
    return getattr(importlib.import_module(f"{package}.msg"), kind)


def _poses(topic: str, model: str, seconds: float) -> list[Pose]:
    from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
    from gz_course.sim.gz.transport.node import Node

    found: list[Pose] = []
    names: set[str] = set()
    came = threading.Condition()

    def take(message: Any) -> None:
        stamp = message.header.stamp
        with came:
            names.update(each.name for each in message.pose)
            found.extend(_pose(stamp.sec + stamp.nsec / 1e9, each) for each in message.pose if each.name == model)
            came.notify()

    with Node() as node:
        node.subscribe(Pose_V, topic, take)
        with came:
            while came.wait(READY):
                if found and found[-1].time - found[0].time >= seconds:
                    return list(found)
                if names and model not in names:
                    raise NotYet(f"The world has no model `{model}`; it has {', '.join(sorted(names))}.")
    raise NotYet(f"The world said nothing of `{model}` for {READY:g} s. Is it paused?")


def _pose(stamp: float, pose: Any) -> Pose:
    q, p = pose.orientation, pose.position
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return Pose(stamp, p.x, p.y, p.z, yaw)
