"""Run a simulation, and look at it: `gz sim FILE -r`.

It loads the world, serves it on gz-transport (`gz.sim.server`) and runs it until SIGINT, SIGTERM or the last iteration.
Beside it a view opens in the browser (`gz_course.sim.gz.view`), unless -s is given; -g opens one of a world that runs
already. Without a FILE a page opens first, on which a world is chosen. The view is a process of its own: whatever
happens to it, the simulation goes on.

Exit codes: 0 normal end, 1 the world cannot be run, 2 no world was named, 3 internal error of the simulator; usage
errors have the codes of `gz.command_line`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/cmd/cmdsim.rb.in
"""

from __future__ import annotations

import argparse
import contextlib
import logging
import signal
import sys
import threading
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.error_text import named
from gz_course.sim.gz.command_line import Parser, integer, positive_number, whole_number

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.sdf.description import Plugin
    from gz_course.sim.gz.sim.world import World
    from gz_course.sim.gz.transport import Node
    from gz_course.sim.gz.view import View
    from gz_course.sim.gz.view.start_page import StartPage

_LEVELS = {0: logging.CRITICAL + 1, 1: logging.WARNING, 2: logging.WARNING, 3: logging.INFO, 4: logging.DEBUG}
_PREFIXES = {logging.WARNING: "[Wrn]", logging.INFO: "[Msg]", logging.DEBUG: "[Dbg]"}
_ACCEPTED = {
    "--force-version": "N",
    "--physics-engine": "NAME",
    "--render-engine-gui": "NAME",
    "--render-engine-api-backend": "NAME",
    "--gui-config": "FILE",
}
_ACCEPTED_FLAGS = ("--levels", "--log-compress", "--record-resources")


def add_arguments(parser: Parser) -> None:
    parser.add_argument("file", nargs="?", help="world: a path, a name in GZ_SIM_RESOURCE_PATH, or a built-in world")
    parser.add_argument("-r", dest="run", action="store_true", help="run at once (without it the world starts paused)")
    parser.add_argument("-s", dest="server", action="store_true", help="server only, without a view")
    parser.add_argument("-g", dest="gui", action="store_true", help="view only, of a world that runs already")
    parser.add_argument(
        "--bind", default="127.0.0.1", metavar="ADDRESS", help="address that the view listens on (default: loopback)"
    )
    parser.add_argument(
        "--http-port", type=whole_number, default=0, metavar="PORT", help="port of the view (0: any that is free)"
    )
    parser.add_argument(
        "-v", "--verbose", nargs="?", type=whole_number, const=3, default=1, metavar="LEVEL",
        help="0 silent, 1 and 2 errors and warnings, 3 messages (plain -v), 4 everything",
    )  # fmt: skip
    parser.add_argument("--iterations", type=whole_number, default=0, metavar="N", help="end after N steps (0: never)")
    parser.add_argument("-z", dest="rate", type=positive_number, metavar="HZ", help="steps per second of wall time")
    parser.add_argument("--seed", type=integer, default=0, metavar="N", help="seed of all sensor noise")
    parser.add_argument(
        "--initial-sim-time", type=positive_number, default=0.0, metavar="S", help="simulated time to start at [s]"
    )
    parser.add_argument("--strict", action="store_true", help="refuse a world that causes warnings")
    recording = parser.add_argument_group("recording (read it with gz tlog)")
    recording.add_argument("--record", action="store_true", help="record poses into ~/.gz/sim/log/TIME/state.tlog")
    recording.add_argument("--record-path", metavar="FOLDER", help="record into this folder")
    recording.add_argument(
        "--record-topic", action="append", default=[], metavar="REGEX", help="record these topics too; may be repeated"
    )
    recording.add_argument(
        "--record-period", type=positive_number, metavar="S", help="shortest time between recorded poses [s]"
    )
    recording.add_argument("--log-overwrite", action="store_true", help="use the folder even if it holds a recording")
    engine = "'auto' (default: OpenGL if it is faster), 'raycast' (always the same bytes), 'mujoco' (OpenGL) or 'fast'"
    for option in ("--render-engine", "--render-engine-server"):
        parser.add_argument(option, dest="render_engine", default="auto", metavar="NAME", help=engine)
        engine = "the same"
    fast = "cameras cast a quarter of their pixels; the same as --render-engine fast"
    parser.add_argument("--fast-camera", dest="render_engine", action="store_const", const="fast", help=fast)
    parser.add_argument("--headless-rendering", action="store_true", help="accepted; sensors never need a display here")
    for option, metavar in _ACCEPTED.items():
        parser.add_argument(option, metavar=metavar, help="accepted, changes nothing here")
    for option in _ACCEPTED_FLAGS:
        parser.add_argument(option, action="store_true", help="accepted, changes nothing here")
    parser.add_argument(
        "--playback", metavar="FOLDER", help="show a recording of --record; its end pauses, and nothing is simulated"
    )


def _set_up_logging(verbose: int) -> None:
    class Formatter(logging.Formatter):
        def format(self, record: logging.LogRecord) -> str:
            return f"{_PREFIXES.get(record.levelno, '[Err]')} {record.getMessage()}"

    handler = logging.StreamHandler()
    handler.setFormatter(Formatter())
    logger = logging.getLogger("gz.sim")
    logger.handlers = [handler]
    logger.propagate = False
    logger.setLevel(_LEVELS.get(verbose, logging.DEBUG))


def run(values: argparse.Namespace) -> int:
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        # Set by another thread, because the handler may have interrupted a wait that holds the event's lock.
        signal.signal(number, lambda _number, _frame: threading.Thread(target=stop.set, daemon=True).start())
    _set_up_logging(values.verbose)
    refused = ""
    if values.gui and not values.server:
        if values.file is None:
            return _view_only(values, stop)
        refused = "-g shows a world that runs already, so it takes no file; leave out -g to start one"
    elif values.playback is not None and (values.file is not None or _recorder(values)):
        refused = "--playback shows a recorded world, so it takes neither a file nor --record; leave out one of them"
    elif values.file is None and values.playback is None and (values.server or not _may_ask()):
        refused = "which world? Name a file or a built-in world, for example: gz sim -r lidar_room.sdf"
    if refused:
        sys.stderr.write(f"gz sim: {refused}\n")
        return 2
    for option in (*_ACCEPTED, *_ACCEPTED_FLAGS):
        if getattr(values, option.removeprefix("--").replace("-", "_")):
            logging.getLogger("gz.sim").warning("%s changes nothing here", option)
    try:
        if values.file is None and values.playback is None:
            return _choose(values, stop)
        return _simulate(values, stop)
    except Exception as error:  # an internal error of the simulator
        logging.getLogger("gz.sim").debug("%s", traceback.format_exc())
        sys.stderr.write(f"gz sim: the simulator itself failed ({named(error)}); -v 4 tells where\n")
        return 3


def _may_ask() -> bool:
    """Return whether a world may be chosen in a browser; a graded run has none."""
    from gz_course.sim.gz.sim.server import Server

    return Server.offers_view


def _choose(values: argparse.Namespace, stop: threading.Event) -> int:
    """Have a world chosen in the browser, and simulate it."""
    from gz_course.sim.gz.sim.sdf.resources import known_worlds
    from gz_course.sim.gz.view.start_page import StartPage

    try:
        page = StartPage(known_worlds(), bind=values.bind, port=values.http_port)
    except OSError as error:
        sys.stderr.write(f"gz sim: the page to choose a world cannot be served: {error.strerror or error}\n")
        return 1
    with page:
        sys.stderr.write(f"gz sim: choose a world at {page.address}\n")
        page.open_browser()
        values.file = page.wait(stop)
        values.http_port = 0  # it is taken by the page
        return _simulate(values, stop, page) if values.file else 0


def _view_only(values: argparse.Namespace, stop: threading.Event) -> int:
    """Show the world that runs in this partition, or the first one that starts, until SIGINT or SIGTERM."""
    from gz_course.sim.gz.view import View

    def ready(view: View) -> None:
        if view.address:
            sys.stderr.write(f"gz sim: see the running world at {view.address}\n")
            view.open_browser()

    with View(
        search=True, bind=values.bind, port=values.http_port, on_ready=ready, on_end=lambda _: stop.set()
    ) as view:
        stop.wait()
    if view.error:
        sys.stderr.write(f"gz sim: there is no view: {view.error}\n")
    return 1 if view.error else 0


def _open_view(values: argparse.Namespace, world: str, page: StartPage | None) -> View:
    """Open a view beside the simulator, and say where; it comes while the world runs already.

    The page on which the world was chosen goes there itself.
    """
    from gz_course.sim.gz.view import View

    def say(sentence: str) -> None:
        if values.verbose > 0:
            sys.stderr.write(f"gz sim: {sentence}\n")

    def ready(view: View) -> None:
        if view.address:
            say(f"see world '{world}' at {view.address}")
            if page is not None:
                page.lead_to(view.address)
            else:
                view.open_browser()

    def ended(view: View) -> None:
        say(f"there is no view ({view.error}); the simulator runs on, and gz sim -g opens another view")

    return View(world, bind=values.bind, port=values.http_port, on_ready=ready, on_end=ended)


def broadcaster() -> Plugin:
    """Return the ViewBroadcaster plugin: a view may be opened at any time."""
    from gz_course.sim.gz.sim.sdf.description import Plugin
    from gz_course.sim.gz.sim.sdf.element import Element

    attributes = {"name": "gz_course::systems::ViewBroadcaster", "filename": "gz-course-view-broadcaster-system"}
    return Plugin(attributes["name"], attributes["filename"], Element("plugin", attributes, file="command line"))


def _recorder(values: argparse.Namespace) -> list[Plugin]:
    """Return the LogRecord plugin for the options, or an empty list."""
    if not (values.record or values.record_path or values.record_topic):
        return []
    texts = [("record_topic", topic) for topic in values.record_topic]
    if values.record_path:
        texts.append(("record_path", values.record_path))
    if values.record_period is not None:
        texts.append(("record_period", repr(values.record_period)))
    if values.log_overwrite:
        texts.append(("overwrite", "true"))
    return [_plugin("LogRecord", "gz-sim-log-record-system", texts)]


def _recorded(path: Path, viewed: list[Plugin]) -> tuple[World, int]:
    """Return the world of a recording, which shows what was recorded, and the time of its end [ns]."""
    from gz_course.sim.gz.sim.errors import Diagnostics
    from gz_course.sim.gz.sim.systems.log_playback import recorded_world
    from gz_course.sim.gz.sim.world import World

    description, end_ns = recorded_world(path)
    playback = _plugin("LogPlayback", "gz-sim-log-playback-system", [("playback_path", str(path))])
    scene = _plugin("SceneBroadcaster", "gz-sim-scene-broadcaster-system", [])
    description.plugins = [playback, scene, *viewed]
    return World(description, Diagnostics(quiet=True)), end_ns


def _plugin(name: str, filename: str, texts: list[tuple[str, str]]) -> Plugin:
    """Return a plugin of the world that the command line asks for, with its parameters."""
    from gz_course.sim.gz.sim.sdf.description import Plugin
    from gz_course.sim.gz.sim.sdf.element import Element

    element = Element("plugin", {"name": f"gz::sim::systems::{name}", "filename": filename}, file="command line")
    element.children = [Element(tag, {}, text, file=element.file) for tag, text in texts]
    return Plugin(element.name, filename, element)


def _look_for_others(node: Node) -> None:
    """Warn if another simulator publishes `/clock` in the same partition; waits about 1 [s] for discovery."""
    from gz_course.sim.gz.sim.errors import LOG

    try:
        others = len(node.topic_info("/clock")[0]) - 1
    except RuntimeError:  # the simulation has ended in the meantime
        return
    if others > 0:
        LOG.warning(
            "another simulator publishes /clock in partition '%s' too, so nodes see time jump to and fro; end it, or "
            "give one of the two another GZ_PARTITION",
            node.options.partition,
        )


def _simulate(values: argparse.Namespace, stop: threading.Event, page: StartPage | None = None) -> int:
    # Imported here, because MuJoCo and the transport would delay help and usage errors.
    from gz_course.sim.gz.sim.errors import LOG, SimError
    from gz_course.sim.gz.sim.server import Server
    from gz_course.sim.gz.sim.world import World
    from gz_course.sim.gz.transport import Node, NodeOptions

    viewed, end_ns = [broadcaster()] if Server.offers_view else [], None
    if values.playback is not None and not Server.offers_view:
        sys.stderr.write("gz sim: a graded run shows no recording; name a world instead of --playback\n")
        return 2
    try:
        if values.playback is not None:
            world, end_ns = _recorded(Path(values.playback), viewed)
        else:
            world = World.load(
                Path(values.file),
                seed=values.seed,
                render_engine=values.render_engine,
                initial_sim_time=values.initial_sim_time,
                strict=values.strict,
                lenient=not values.strict,
                server_plugins=[*_recorder(values), *viewed],
            )
    except SimError as error:
        sys.stderr.write(f"gz sim: {error}\n")
        return 1
    try:
        node = Node(NodeOptions(synchronous=True))
    except (OSError, RuntimeError, ValueError) as error:
        sys.stderr.write(f"gz sim: the transport cannot be opened ({error}); check GZ_IP and GZ_PARTITION\n")
        return 1
    with node, contextlib.ExitStack() as views:
        try:
            server = Server(world, node)
            server.paused = not values.run
            if end_ns is not None:
                server.control.end_ns = end_ns
            threading.Thread(target=_look_for_others, args=(node,), daemon=True).start()
            LOG.info("world '%s' is loaded with models %s", world.name, world.model_names(static=True))
            seen = server.offers_view and not values.server
            if server.paused:
                how = "start it with -r, or press Play in the view" if seen else "start it with -r to let time run"
                LOG.warning("world '%s' is paused; %s", world.name, how)
            if seen:
                views.enter_context(_open_view(values, world.name, page))
            elif server.offers_view and values.verbose > 0:
                where = f"partition '{node.options.partition}'"
                sys.stderr.write(f"gz sim: world '{world.name}' is served in {where}; gz sim -g shows it\n")
            server.run(update_rate=values.rate, iterations=values.iterations, stop=stop)
        except SimError as error:
            sys.stderr.write(f"gz sim: {error}\n")
            return 1
        finally:
            world.close()
    return 0
