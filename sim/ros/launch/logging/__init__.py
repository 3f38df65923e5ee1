"""The log of a launch: lines on the screen and in `launch.log`.

    launch.logging.get_logger("my_launch").info("up and running")

prints `[INFO] [my_launch]: up and running` and writes the same with a time stamp to `launch.log`. The environment
variables OVERRIDE_LAUNCH_SCREEN_FORMAT and OVERRIDE_LAUNCH_LOG_FORMAT change these lines. The log folder is
`<date>-<time>-<host>-<pid>` below ROS_LOG_DIR, else ROS_HOME/log, else ~/.ros/log; the first logged line creates it.

Source: ros2/launch, launch/launch/logging/__init__.py
"""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import sys
import time
from datetime import datetime
from pathlib import Path
from typing import TextIO

SCREEN_FORMAT = "[{0.levelname}] [{0.name}]: {1}"
LOG_FORMAT = "{0.created:.7f} [{0.levelname}] [{0.name}]: {1}"


class LaunchConfig:
    """Level, log folder, screen and log file of the process; the only instance is `launch_config`."""

    def __init__(self) -> None:
        self._log_file: TextIO | None = None
        self._reset()

    def _reset(self) -> None:
        self._screen_format = _given_format("OVERRIDE_LAUNCH_SCREEN_FORMAT")
        self._log_format = _given_format("OVERRIDE_LAUNCH_LOG_FORMAT")
        if self._log_file is not None:
            self._log_file.close()
        self._level = logging.INFO
        self._log_dir: str | None = None
        self._log_file = None
        self._announced = False
        self._screen_is_gone = False

    @property
    def level(self) -> int:
        """Return the level below which nothing is logged; set it to a number or a name of `logging`."""
        return self._level

    @level.setter
    def level(self, level: int | str) -> None:
        number = logging.getLevelName(level.upper()) if isinstance(level, str) else level
        if not isinstance(number, int):
            raise ValueError(f"{level!r} is no logging level; debug, info, warning, error and critical are")
        self._level = number
        for logger in _loggers.values():
            logger.setLevel(number)

    @property
    def log_dir(self) -> str:
        """Return the folder of this process's log files, and create it."""
        if self._log_dir is None:
            self._open_log()
        assert self._log_dir is not None
        return self._log_dir

    @log_dir.setter
    def log_dir(self, path: str) -> None:
        if self._log_dir is not None:
            raise RuntimeError(f"the log folder is in use already: {self._log_dir}")
        self._open_log(Path(path))

    def get_log_file_path(self, file_name: str = "launch.log") -> str:
        return str(Path(self.log_dir) / file_name)

    def announce(self) -> None:
        """Log the log folder and the verbosity once."""
        if self._announced:
            return
        self._announced = True
        folder = self.log_dir
        get_logger("launch").info(f"All log files can be found below {folder}")
        get_logger("launch").info(f"Default logging verbosity is set to {logging.getLevelName(self._level)}")

    def write_record(self, record: logging.LogRecord) -> None:
        """Write a record of a logger to screen and launch.log."""
        message = record.getMessage()
        if record.exc_info:
            message += "\n" + logging.Formatter().formatException(record.exc_info)
        self.write_to_screen(_line(self._screen_format, SCREEN_FORMAT, record, message))
        self.write_to_log(_line(self._log_format, LOG_FORMAT, record, message))

    def write_to_screen(self, text: str) -> None:
        """Write whole lines to stdout; a closed pipe does not stop the launch."""
        if self._screen_is_gone:
            return
        try:
            sys.stdout.write(text)
            sys.stdout.flush()
        except UnicodeEncodeError:
            encoding = sys.stdout.encoding
            self.write_to_screen(text.encode(encoding, "replace").decode(encoding))
        except (OSError, ValueError):
            self._screen_is_gone = True
            with contextlib.suppress(OSError, ValueError):
                # Buffered text would fail again, with a traceback, when Python exits.
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

    def write_to_log(self, text: str) -> None:
        """Write whole lines to launch.log, if it can be created."""
        if self._log_dir is None:
            self._open_log()
        if self._log_file is not None:
            with contextlib.suppress(OSError, ValueError):
                self._log_file.write(text)
                self._log_file.flush()

    def _open_log(self, folder: Path | None = None) -> None:
        base = folder.parent if folder is not None else _log_base()
        if folder is None:
            now = datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
            folder = base / f"{now}-{socket.gethostname()}-{os.getpid()}"
        self._log_dir = str(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._log_file = (folder / "launch.log").open("a", encoding="utf-8", errors="replace")
        except OSError as error:
            get_logger("launch").warning(
                f"there will be no log files: {folder} cannot be made ({error.strerror}); set ROS_LOG_DIR to a folder "
                "that can be written to"
            )
            return
        with contextlib.suppress(OSError):
            _point_latest_at(base, folder)


def _given_format(variable: str) -> logging.Formatter | None:
    """Return the line format that an environment variable gives, None for the default.

    The fields are those of `logging.Formatter` in style `{`, in which escapes such as that of a tab are
    replaced. Two names stand for formats: `default` and `default_with_timestamp`.
    """
    text = os.environ.get(variable, "")
    if text in ("", "default"):
        return None
    if text == "default_with_timestamp":
        text = "{created:.7f} [{levelname}] [{name}]: {msg}"
    try:
        formatter = logging.Formatter(text.encode("latin1", "replace").decode("unicode_escape"), style="{")
        formatter.format(logging.LogRecord("launch", logging.INFO, "", 0, "", (), None))
    except (ValueError, KeyError, IndexError, AttributeError, TypeError) as error:
        print(f"{variable}={text!r} is no format of log lines ({error}); the default is used", file=sys.stderr)
        return None
    return formatter


def _line(given: logging.Formatter | None, default: str, record: logging.LogRecord, message: str) -> str:
    if given is None:
        return default.format(record, message) + "\n"
    copy = logging.makeLogRecord({**record.__dict__, "msg": message, "args": (), "exc_info": None})
    return given.format(copy) + "\n"


def _log_base() -> Path:
    if os.environ.get("ROS_LOG_DIR"):
        return Path(os.environ["ROS_LOG_DIR"]).expanduser()
    if os.environ.get("ROS_HOME"):
        return Path(os.environ["ROS_HOME"]).expanduser() / "log"
    return Path("~/.ros/log").expanduser()


def _point_latest_at(base: Path, folder: Path) -> None:
    """Point the link `latest` to this run's folder; safe for simultaneous launches."""
    link = base / f".latest-{os.getpid()}"
    link.unlink(missing_ok=True)
    link.symlink_to(folder.name)
    if (base / "latest").is_symlink() or not (base / "latest").exists():
        link.replace(base / "latest")
    else:
        link.unlink()


class _Handler(logging.Handler):
    """Writes to screen and log file."""

    def emit(self, record: logging.LogRecord) -> None:
        launch_config.write_record(record)


class _Logger(logging.Logger):
    """A logger outside of the hierarchy of `logging`, which therefore does not update its level cache."""

    def isEnabledFor(self, level: int) -> bool:
        return level >= self.level


_loggers: dict[str, logging.Logger] = {}
_handler = _Handler()
launch_config = LaunchConfig()


def get_logger(name: str = "launch") -> logging.Logger:
    """Return the logger of this name, which is independent of the loggers of `logging`."""
    if name not in _loggers:
        logger = _Logger(name, launch_config.level)
        logger.addHandler(_handler)
        _loggers[name] = logger
    return _loggers[name]


def reset() -> None:
    """Reset log folder and level, so that the next launch of this process gets its own."""
    launch_config._reset()
    launch_config.level = logging.INFO


def stamp() -> str:
    """Return the present time [s since 1970] in the format of launch.log."""
    return f"{time.time():.7f}"
