"""Why a program that should last has ended at its start: a log file, which outlives the terminal it was told in.

The file stands among ROS's own log files, named (`PROGRAM_PID_MILLISECONDS.log`) and written as they are.
`leave` writes one, `found` reads those of a folder; a program that is started again begins with `forget`.

Source: naming of log files in rcl_logging_spdlog, https://github.com/ros2/rcl_logging
"""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

LOOK_BACK = 1800.0
"""Age [s] after which last words are of no interest."""
_MOST_BYTES = 64 * 1024
_NAME = re.compile(r"(?P<program>.+)_(?P<pid>\d+)_(?P<ms>\d+)\.log")
_LINE = re.compile(r"\[(?P<level>INFO|FATAL)\] \[\d+\.\d+\] \[[^]]*\]: (?P<text>.*)")
_PLACE = "ROS domain {}, Gazebo partition {}"


@dataclass(frozen=True)
class LastWords:
    """What a program said before it ended, where it was, and when [s since 1970]."""

    program: str
    pid: int
    ended: float
    domain: int
    partition: str
    sentences: tuple[str, ...]

    @property
    def file_name(self) -> str:
        return f"{self.program}_{self.pid}_{int(self.ended * 1000)}.log"

    @property
    def place(self) -> tuple[str, int, str]:
        """Program, domain and partition: what is started there again is its successor."""
        return self.program, self.domain, self.partition


def leave(folder: Path, words: LastWords) -> None:
    """Write the file; a folder that cannot be written is passed over."""
    stamp = f"[{words.ended:.9f}] [{words.program}]"
    lines = [f"[INFO] {stamp}: {_PLACE.format(words.domain, words.partition)}"]
    lines += [f"[FATAL] {stamp}: {' '.join(sentence.split())}" for sentence in words.sentences]
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / words.file_name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def forget(folder: Path, place: tuple[str, int, str], within: float = LOOK_BACK) -> None:
    """Remove the files of a program in one domain and partition."""
    for words in found(folder, within, place[0]):
        if words.place == place:
            with contextlib.suppress(OSError):
                (folder / words.file_name).unlink()


def found(folder: Path, within: float = LOOK_BACK, program: str = "") -> list[LastWords]:
    """Return what was left in a folder of logs in the last `within` seconds, by any or by one program, oldest first."""
    since = time.time() - within
    return sorted(_read(folder, since, program), key=lambda words: words.ended)


def _read(folder: Path, since: float, program: str) -> Iterator[LastWords]:
    files: Iterable[Path] = ()
    with contextlib.suppress(OSError):
        files = list(folder.iterdir())
    for file in files:
        name = _NAME.fullmatch(file.name)
        if name is None or int(name["ms"]) / 1000 < since or program not in ("", name["program"]):
            continue
        lines: list[str] = []
        with contextlib.suppress(OSError), file.open(encoding="utf-8", errors="replace") as stream:
            lines = stream.read(_MOST_BYTES).splitlines()
        said = [line for line in map(_LINE.fullmatch, lines) if line is not None]
        place = re.fullmatch(_PLACE.format(r"(\d+)", "(.*)"), said[0]["text"]) if said else None
        sentences = tuple(line["text"] for line in said if line["level"] == "FATAL")
        if place is not None and sentences:
            domain, partition = int(place[1]), place[2]
            yield LastWords(name["program"], int(name["pid"]), int(name["ms"]) / 1000, domain, partition, sentences)
