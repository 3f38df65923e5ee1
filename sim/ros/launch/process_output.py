"""The output of processes: on the screen, in launch.log and in files of their own.

`output=` of an action selects:

    screen   both streams on the screen
    log      both in launch.log, stderr also on the screen (the default)
    both     both in launch.log and on the screen
    own_log  <label>-stdout.log, <label>-stderr.log and <label>.log (both streams) in the log folder, lines as on screen
    full     all of these

or with a dict: `{"stdout": "screen", "stderr": {"log", "own_log"}}`.

Source: ros2/launch, launch/launch/logging/__init__.py (get_output_loggers)
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, BinaryIO

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.logging import launch_config, stamp

_LONGEST_LINE = 65536  # bytes; longer output without a newline is split, to bound memory
STREAMS = ("stdout", "stderr")
_OVERRIDE = "OVERRIDE_LAUNCH_PROCESS_OUTPUT"
_SINKS = ("screen", "log", "own_log")
_OWN_OF_BOTH = "own_log_of_both"
_WORDS: dict[str, dict[str, set[str]]] = {
    "screen": {"both": {"screen"}},
    "log": {"both": {"log"}, "stderr": {"screen"}},
    "both": {"both": {"screen", "log"}},
    "own_log": {"both": {"own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
    "full": {"both": {"screen", "log", "own_log"}, "stdout": {"own_log"}, "stderr": {"own_log"}},
}


def sinks(output: str | dict[str, Any]) -> dict[str, set[str]]:
    """Return the sinks of each stream for an `output=` argument. Raises LaunchError for unknown words."""
    chosen: dict[str, Any]
    output = os.environ.get(_OVERRIDE) or output
    if isinstance(output, str):
        if output not in _WORDS:
            raise LaunchError(f"output='{output}' means nothing{did_you_mean(output, _WORDS, listing='it can be')}")
        chosen = _WORDS[output]
    elif isinstance(output, dict):
        chosen = output
    else:
        raise LaunchError(f"output={output!r} is of type {type(output).__name__}; a word or a dict is expected")
    result: dict[str, set[str]] = {stream: set() for stream in STREAMS}
    for key, words in chosen.items():
        if key not in (*STREAMS, "both"):
            hint = did_you_mean(str(key), (*STREAMS, "both"), listing="it can have")
            raise LaunchError(f"output has the key '{key}'{hint}")
        for word in [words] if isinstance(words, str) else words:
            if word not in _SINKS:
                raise LaunchError(f"output of {key} is '{word}'{did_you_mean(str(word), _SINKS, listing='it can be')}")
            for stream in STREAMS if key == "both" else (key,):
                result[stream].add(_OWN_OF_BOTH if key == "both" and word == "own_log" else word)
    return result


class ProcessOutput:
    """The output of one process under its label; `line_format(line)` formats a line for the screen."""

    def __init__(
        self, label: str, output: str | dict[str, Any], *, cached: bool, line_format: Callable[[str], str] | None
    ) -> None:
        self._label = label
        self._sinks = sinks(output)
        self._rest = {stream: b"" for stream in STREAMS}
        self._cache: dict[str, bytearray] | None = {stream: bytearray() for stream in STREAMS} if cached else None
        self._format = line_format or (lambda line: f"[{label}] {line}")
        self._files: dict[str, BinaryIO] = {}

    def feed(self, stream: str, data: bytes) -> None:
        """Write the lines that are complete after `data` was read from a stream."""
        if self._cache is not None:
            self._cache[stream] += data
        complete, newline, rest = (self._rest[stream] + data).rpartition(b"\n")
        self._rest[stream] = rest
        if newline:
            self._write(stream, complete.split(b"\n"))
        if len(rest) > _LONGEST_LINE:
            self._rest[stream] = b""
            self._write(stream, [rest])

    def flush(self) -> None:
        for stream, rest in self._rest.items():
            if rest:
                self._rest[stream] = b""
                self._write(stream, [rest])

    def close(self) -> None:
        self.flush()
        for file in self._files.values():
            file.close()
        self._files.clear()

    def cached(self, stream: str) -> bytes:
        """Return the output of a stream so far. Raises LaunchError without `cached`."""
        if self._cache is None:
            raise LaunchError(f"the {stream} of {self._label} was not kept; give the action cached_output=True")
        return bytes(self._cache[stream])

    def _write(self, stream: str, raw: list[bytes]) -> None:
        sinks = self._sinks[stream]
        lines = [line.removesuffix(b"\r").decode(errors="replace") for line in raw]
        if "log" in sinks:
            launch_config.write_to_log("".join([f"{stamp()} [{self._label}] {line}\n" for line in lines]))
        if "screen" in sinks:
            launch_config.write_to_screen("".join([self._format(line) + "\n" for line in lines]))
        if "own_log" in sinks:
            self._write_file(f"{self._label}-{stream}.log", lines)
        if _OWN_OF_BOTH in sinks:
            self._write_file(f"{self._label}.log", lines)

    def _write_file(self, name: str, lines: Iterable[str]) -> None:
        with contextlib.suppress(OSError):
            if name not in self._files:
                path = Path(launch_config.log_dir) / name.replace(os.sep, "_")
                self._files[name] = path.open("ab", buffering=0)
            self._files[name].write("".join([self._format(line) + "\n" for line in lines]).encode(errors="replace"))
