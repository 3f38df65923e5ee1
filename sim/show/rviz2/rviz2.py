"""The program `ros2 run rviz2 rviz2` where no RViz is installed, and `course watch`: what ROS says, live, in Rerun.

Topics appear as they come: scans, pictures, clouds, odometry with its path, `/tf`, markers, maps; of all else the
numbers are plotted, and texts and `/rosout` are logged. Ends with Ctrl-C or when the window is closed; nothing is left.

Source: https://github.com/ros2/rviz (rviz_common/src/rviz_common/visualizer_app.cpp: options -d and -f)
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from gz_course.sim.ros.ros_program.errors import Failure, UsageError
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal
from gz_course.sim.show.rviz2.viewer import Viewer, ViewerError, has_display

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "rviz2"
APPLICATION = "gz_course_live"
MISSING_AFTER = 10  # looks at the graph, before topics that nobody publishes are named


def parser(program: str = NAME) -> argparse.ArgumentParser:
    """Return the parser of the program's own arguments."""
    made = _Parser(prog=program, add_help=False, description="Shows what ROS says, live, in Rerun.")
    made.add_argument("topics", nargs="*", metavar="TOPIC", help="topics or patterns; all if none is given")
    made.add_argument("--plot", action="append", default=[], metavar="TOPIC/FIELD", help="a field to plot; repeatable")
    made.add_argument("-f", "--fixed-frame", default="", metavar="FRAME", help="the frame to look from")
    made.add_argument("--web", action="store_true", help="in a browser instead of a window; of this machine only")
    made.add_argument("--no-browser", action="store_true", help="with --web: open no browser, print the address only")
    made.add_argument("--save", type=Path, metavar="FILE.rrd", help="write a file instead of showing anything")
    made.add_argument("-d", "--display-config", metavar="FILE", help="RViz's configuration; not read here")
    return made


def main(argv: list[str] | None = None, program: str = NAME) -> int:
    """Show what comes until Ctrl-C and return the exit code."""
    return run(program, NAME, _work(program), parser(program).format_help(), argv, lasting=True, images=True)


def _work(program: str) -> Callable[[Node, list[str]], int]:
    def work(node: Node, arguments: list[str]) -> int:
        given = parser(program).parse_args(arguments)
        if given.display_config:
            print(f"{given.display_config} is not read: everything that is published is shown", file=sys.stderr)
        try:
            return watch(node, given)
        except ViewerError as error:
            raise Failure(str(error)) from None

    return work


def watch(node: Node, given: argparse.Namespace) -> int:
    """Draw what the node hears until SIGINT or SIGTERM. Raises ViewerError if there is no viewer."""
    import rerun as rr
    from rclpy.clock import Clock, ClockType

    from gz_course.sim.show.rviz2.canvas import Canvas
    from gz_course.sim.show.rviz2.layout import layout
    from gz_course.sim.show.rviz2.page import open_browser
    from gz_course.sim.show.rviz2.subscriber import LOOK_S, Subscriber

    stream = rr.RecordingStream(APPLICATION, send_properties=False)
    with contextlib.ExitStack() as stack:
        viewer = None
        if given.save is not None:
            _save(stream, given.save)
        else:
            viewer = stack.enter_context(Viewer(web=given.web or not has_display()))
            stream.connect_grpc(viewer.stream_url)
            if viewer.web:
                open_browser(viewer.address, wanted=not given.no_browser)
        stack.callback(stream.disconnect)
        canvas = Canvas(stream, lambda sentence: print(f"{NAME}: {sentence}", file=sys.stderr, flush=True))

        def lay_out() -> None:
            stream.send_blueprint(layout(canvas.pictures, given.plot, given.fixed_frame))

        shown: list[list[str]] = []

        def on_change() -> None:
            if not shown or shown[-1] != canvas.pictures:  # the layout is the user's as long as nothing new needs room
                shown[:] = [list(canvas.pictures)]
                lay_out()

        subscriber = Subscriber(node, canvas, given.topics, on_change)
        looks = 0

        def look() -> None:
            nonlocal looks
            if viewer is not None and not viewer.is_running:  # its window was closed
                os.kill(os.getpid(), signal.SIGTERM)
                return
            subscriber.look()
            looks += 1
            if looks == MISSING_AFTER:
                for name in subscriber.missing():
                    canvas.say(f"nobody publishes {name} yet")

        lay_out()
        look()
        timer = node.create_timer(LOOK_S, look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        code = wait_for_signal(node)
        node.destroy_timer(timer)
        if viewer is not None:
            viewer.check()
    return code


def _save(stream: Any, path: Path) -> None:
    if path.suffix != ".rrd" or not path.parent.is_dir() or path.is_dir():
        raise UsageError(f"--save {path}: give the name of a file that ends with .rrd, in a folder that exists")
    stream.save(path)
    print(f"writing {path}; Ctrl-C ends it", flush=True)


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(message)


if __name__ == "__main__":
    sys.exit(main())
