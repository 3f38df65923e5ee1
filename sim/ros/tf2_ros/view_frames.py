"""The program `ros2 run tf2_tools view_frames`: draws the tree of all frames that are published.

It listens for 5 s, writes `frames_DATE.gv`, and has Graphviz's `dot` make `frames_DATE.pdf` of it. Without `dot` the
`.gv` file stays the result. Exit codes: 0, also after SIGINT and SIGTERM, 2 for unusable arguments, 1 if a file cannot
be written.

Source: tf2_tools/tf2_tools/view_frames.py of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import argparse
import math
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import yaml

from gz_course.sim.ros.ros_program.errors import Failure, UsageError
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import STOP_SIGNALS, Spinner

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "view_frames"
DOT_S = 60.0  # [s] for `dot`


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise UsageError(message)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog=NAME, description="Create a diagram of the TF frames being broadcast over ROS")
    parser.add_argument(
        "--wait-time", "-t", type=float, default=5.0, help="seconds to listen before the tree is drawn (default 5)"
    )
    parser.add_argument("-o", "--output", help="name of the files without .gv and .pdf (default frames_DATE)")
    parser.add_argument("--tf_topic", default="/tf", help="topic of the transforms that change")
    parser.add_argument("--tf_static_topic", default="/tf_static", help="topic of the static transforms")
    return parser


def main(argv: list[str] | None = None) -> int:
    """Listen, draw, and return the exit code."""
    return run(NAME, NAME, _view, _parser().format_help(), argv, lasting=True)


def _view(node: Node, arguments: list[str]) -> int:
    from gz_course.sim.ros.tf2_ros.buffer import Buffer
    from gz_course.sim.ros.tf2_ros.transform_listener import TransformListener

    given = _parser().parse_args(arguments)
    if not 0.0 <= given.wait_time < math.inf:
        raise UsageError(f"--wait-time must be 0 or more seconds, not {given.wait_time}")
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node, tf_topic=given.tf_topic, tf_static_topic=given.tf_static_topic)
    logger = node.get_logger()
    logger.info(f"Listening to tf data for {given.wait_time} seconds...")
    with Spinner(node) as spinner:
        stopped = signal.sigtimedwait(STOP_SIGNALS, given.wait_time)
    del listener
    if spinner.error:
        raise Failure(f"a callback failed: {spinner.error}")
    if stopped is not None:
        return 0
    logger.info("Generating graph...")
    try:
        text = dot_text(frames_of(buffer.all_frames_as_yaml()), node.get_clock().now().nanoseconds * 1e-9)
    except (yaml.YAMLError, TypeError, KeyError, AttributeError):
        raise Failure("a frame has a name that cannot stand in YAML, so the tree cannot be read") from None
    graph = Path(f"{given.output or time.strftime('frames_%Y-%m-%d_%H.%M.%S')}.gv")
    try:
        graph.write_text(text)
    except OSError as error:
        raise Failure(f"{graph} cannot be written: {error.strerror}") from None
    _draw(graph, logger)
    return 0


def frames_of(text: str) -> Any:
    """Return the frames of `all_frames_as_yaml`; all values are texts, since a name may look like something else."""
    return yaml.load(text, Loader=yaml.BaseLoader)


def dot_text(frames: dict[str, dict[str, str]], now: float) -> str:
    """Return the graph of the frames, recorded at the time `now` [s]."""
    if not frames:
        return 'digraph G { "No tf data received" }'
    text = "digraph G {\n"
    for name, frame in frames.items():
        text += (
            f'"{_escaped(frame["parent"])}" -> "{_escaped(name)}"[label=" Broadcaster: {_escaped(frame["broadcaster"])}'
            f"\\nAverage rate: {frame['rate']}\\nBuffer length: {frame['buffer_length']}"
            f"\\nMost recent transform: {frame['most_recent_transform']}"
            f'\\nOldest transform: {frame["oldest_transform"]}\\n"];\n'
        )
    roots = {frame["parent"]: None for frame in frames.values() if frame["parent"] not in frames}
    root = next(reversed(roots), next(iter(frames)))
    return (
        f"{text}edge [style=invis];\n"
        f' subgraph cluster_legend {{ style=bold; color=black; label ="view_frames Result";\n'
        f'"Recorded at time: {now}"[ shape=plaintext ] ;\n}}->"{_escaped(root)}";\n}}'
    )


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')


def _draw(graph: Path, logger: Any) -> None:
    picture = graph.with_name(f"{graph.name.removesuffix('.gv')}.pdf")
    dot = shutil.which("dot")
    if dot is None:
        logger.warning(f"{graph} is written, but no {picture}: Graphviz is not installed, which has the program dot")
        return
    logger.info(f"Exporting graph in {picture} file...")
    try:
        done = subprocess.run(
            [dot, "-Tpdf", graph, "-o", picture], capture_output=True, text=True, timeout=DOT_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Failure(f"dot did not make {picture} of {graph}: {error}") from None
    if done.returncode:
        raise Failure(f"dot did not make {picture} of {graph}: {done.stderr.strip()[:300]}")


if __name__ == "__main__":
    sys.exit(main())
