"""Run a simulation: `gz sim FILE -r -s`.

Reads the arguments, loads the world, puts it on the wire (`gz.sim.server`) and runs it until SIGINT,
SIGTERM or the last iteration. Exit codes: 0 ended well, 1 the world cannot be run, 2 the arguments make
no sense.
"""

from __future__ import annotations

import argparse
import difflib
import logging
import math
import signal
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

_LEVELS = {0: logging.CRITICAL + 1, 1: logging.WARNING, 2: logging.WARNING, 3: logging.INFO, 4: logging.DEBUG}
_PREFIXES = {logging.WARNING: "[Wrn]", logging.INFO: "[Msg]", logging.DEBUG: "[Dbg]"}


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one sentence, with the nearest option, and exits with 2."""

    def error(self, message: str) -> NoReturn:
        if message.startswith("unrecognized arguments: "):
            unknown = message.removeprefix("unrecognized arguments: ").split()[0]
            options = [option for action in self._actions for option in action.option_strings]
            close = difflib.get_close_matches(unknown, options, n=1, cutoff=0.5)
            hint = f"did you mean '{close[0]}'?" if close else "see gz sim --help"
            message = f"there is no option or second file '{unknown}'; {hint}"
        sys.stderr.write(f"gz sim: {message}\n")
        raise SystemExit(2)


def _number(text: str) -> float:
    value = float(text)
    if not math.isfinite(value) or value < 0.0:
        raise argparse.ArgumentTypeError(f"must be zero or more, got {text}")
    return value


def _count(text: str) -> int:
    value = int(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"must be zero or more, got {text}")
    return value


def _parser() -> _Parser:
    parser = _Parser(prog="gz sim", description="Run a simulation.", allow_abbrev=False)
    parser.add_argument("file", nargs="?", help="world: a path, a name in GZ_SIM_RESOURCE_PATH, or a built-in world")
    parser.add_argument("-r", dest="run", action="store_true", help="run at once (without it the world starts paused)")
    parser.add_argument("-s", dest="server", action="store_true", help="server only; there is no other way here")
    parser.add_argument("-g", dest="gui", action="store_true", help="the window of a full Gazebo; refused here")
    parser.add_argument(
        "-v", "--verbose", dest="verbose", nargs="?", type=_count, const=3, default=1, metavar="LEVEL",
        help="0 silent, 1 and 2 errors and warnings, 3 messages (plain -v), 4 everything",
    )  # fmt: skip
    parser.add_argument("--iterations", type=_count, default=0, metavar="N", help="end after N steps (0: never)")
    parser.add_argument("-z", dest="rate", type=_number, metavar="HZ", help="steps per second of wall time")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of all sensor noise")
    parser.add_argument("--headless-rendering", action="store_true", help="accepted; sensors never need a display here")
    parser.add_argument("--force-version", metavar="N", help="accepted, there is one version")
    parser.add_argument("--physics-engine", metavar="NAME", help="accepted, MuJoCo is always used")
    parser.add_argument("--render-engine", metavar="NAME", help="accepted, rays are always cast by MuJoCo")
    return parser


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


def main(argv: Sequence[str] | None = None) -> int:
    """Run `gz sim` with these arguments (default: those of the process after `gz sim`); return the exit
    code.
    """
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda _number, _frame: stop.set())
    arguments = _parser().parse_args(sys.argv[2:] if argv is None else list(argv))
    _set_up_logging(arguments.verbose)
    if arguments.gui:
        sys.stderr.write("gz sim: -g asks for Gazebo's window, which is not part of this simulator; use -s\n")
        return 2
    if arguments.file is None:
        sys.stderr.write(
            "gz sim: which world? Name a file or a built-in world, for example: gz sim -r lidar_room.sdf\n"
        )
        return 2
    return _simulate(arguments, stop)


def _simulate(arguments: argparse.Namespace, stop: threading.Event) -> int:
    # These load MuJoCo and the transport; help and usage errors do not wait for them.
    from gz.sim.errors import LOG, SimError
    from gz.sim.server import Server
    from gz.sim.world import World
    from gz.transport import Node

    try:
        world = World.load(Path(arguments.file), seed=arguments.seed)
    except SimError as error:
        sys.stderr.write(f"gz sim: {error}\n")
        return 1
    try:
        node = Node()
    except (OSError, RuntimeError, ValueError) as error:
        sys.stderr.write(f"gz sim: the transport cannot be opened ({error}); check GZ_IP and GZ_PARTITION\n")
        return 1
    with node:
        server = Server(world, node)
        server.paused = not arguments.run
        LOG.info("world '%s' is loaded with models %s", world.name, world.model_names(static=True))
        if server.paused:
            LOG.warning("world '%s' is paused; start it with -r to let time run", world.name)
        factor = None if arguments.rate is None else arguments.rate * world.step_size_ns * 1e-9
        try:
            server.run(real_time_factor=factor, iterations=arguments.iterations, stop=stop)
        finally:
            world.close()
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
