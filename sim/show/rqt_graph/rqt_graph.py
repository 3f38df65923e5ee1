"""The program `ros2 run rqt_graph rqt_graph` where no rqt is installed, and `course graph`.

Draws nodes, topics, bridges and Gazebo's side, live in a browser of this machine, or once into an SVG file.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.terminal_text import guard

if TYPE_CHECKING:
    from gz_course.sim.gz.transport import Node as GzNode
    from gz_course.sim.ros.ros2.graph import Graph
    from gz_course.sim.show.rqt_graph.observed import End

NAME = "rqt_graph"
_LOOK_S = 0.5  # [s] between two looks at the graphs


def parser(program: str = NAME) -> argparse.ArgumentParser:
    """Return the parser of the program's own arguments."""
    made = argparse.ArgumentParser(prog=program, description="Draws nodes, topics, bridges and Gazebo as one picture.")
    made.add_argument("--svg", type=Path, metavar="FILE.svg", help="write one picture into a file and end")
    made.add_argument(
        "--all", action="store_true", help="also /rosout, /parameter_events and topics of Gazebo with one end"
    )
    made.add_argument("--no-browser", action="store_true", help="open no browser, print the address only")
    return made


def main(argv: list[str] | None = None, program: str = NAME) -> int:
    """Draw until Ctrl-C, or once; return the exit code."""
    if argv is None:
        guard()
    given = parser(program).parse_args(_without_ros_arguments(sys.argv[1:] if argv is None else argv))
    if given.svg is not None and not given.svg.absolute().parent.is_dir():
        print(f"{program}: {given.svg} cannot be written: there is no such folder", file=sys.stderr)
        return 1
    from gz_course.sim.ros.ros2 import graph, interruption
    from gz_course.sim.ros.ros2.errors import CommandError

    interruption.listen()
    try:
        with graph.Graph(argparse.Namespace(spin_time=None, use_sim_time=False)) as ros, _gz_node() as gz:
            ros.settle()
            if given.svg is not None:
                given.svg.write_text(_drawn(ros, gz, given.all), encoding="utf-8")
                print(f"written: {given.svg}")
            else:
                _serve(ros, gz, given)
    except CommandError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{program}: {error.filename or 'the page'}: {error.strerror}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0
    finally:
        interruption.ignore()
        graph.destroy_ended()
    return 0


def _without_ros_arguments(words: list[str]) -> list[str]:
    """Leave out what stands between `--ros-args` and `--`, which launch files add."""
    kept: list[str] = []
    inside = False
    for word in words:
        if word in ("--ros-args", "--"):
            inside = word == "--ros-args"
        elif not inside:
            kept.append(word)
    return kept


def _serve(ros: Graph, gz: GzNode | None, given: argparse.Namespace) -> None:
    from gz_course.sim.show.rqt_graph.page import Page
    from gz_course.sim.show.rviz2.page import open_browser

    with Page() as page:
        page.show(_drawn(ros, gz, given.all))
        open_browser(page.address, wanted=not given.no_browser)
        while True:
            ros.spin_for(_LOOK_S)
            page.show(_drawn(ros, gz, given.all))


@contextlib.contextmanager
def _gz_node() -> Iterator[GzNode | None]:
    """Open a node on Gazebo's side; None if its network cannot be used, which leaves ROS."""
    from gz_course.sim.gz.transport import Node

    try:
        node = Node()
    except OSError as error:
        print(f"{NAME}: Gazebo's side is not to be seen: {error.strerror or error}", file=sys.stderr)
        yield None
        return
    with node:
        yield node


def _drawn(ros: Graph, gz: GzNode | None, everything: bool) -> str:
    from gz_course.sim.show.rqt_graph.observed import picture
    from gz_course.sim.show.rqt_graph.svg import svg

    return svg(picture(ros.nodes(), ros_ends(ros), [] if gz is None else gz_ends(gz), everything=everything))


def ros_ends(ros: Graph) -> list[End]:
    """Return all publishers and subscribers of ROS but hidden ones."""
    from gz_course.sim.ros.ros2.graph import UNKNOWN_NODE, is_hidden
    from gz_course.sim.show.rqt_graph.observed import End

    found = []
    for topic, _ in ros.topics():
        for publishes, infos in (
            (True, ros.node.get_publishers_info_by_topic(topic)),
            (False, ros.node.get_subscriptions_info_by_topic(topic)),
        ):
            for info in infos:
                owner = f"{info.node_namespace.rstrip('/')}/{info.node_name}"
                if UNKNOWN_NODE not in owner and not is_hidden(owner):
                    found.append(End(topic, owner, info.topic_type, publishes))
    return found


def gz_ends(gz: GzNode) -> list[End]:
    """Return all publishers and subscribers of the present partition."""
    from gz_course.sim.show.rqt_graph.observed import End

    publishers, subscribers = gz.publishers_and_subscribers()
    return [
        End(end.topic, end.p_uuid, end.msg_type_name, publishes)
        for publishes, ends in ((True, publishers), (False, subscribers))
        for end in ends
    ]


if __name__ == "__main__":
    raise SystemExit(main())
