"""Program that expands one xacro file to standard output, each element marked with its file and line.

Started by `xacro_file.expand` with the arguments `FILE [NAME:=VALUE ...]`. Exit code 0 and the XML on standard output,
or exit code 1 and a JSON line `{"error": sentence}` as the last line of standard error.

Source: https://wiki.ros.org/xacro
"""

from __future__ import annotations

import contextlib
import json
import re
import resource
import sys
import xml.dom.expatbuilder
import xml.dom.minidom
import xml.parsers.expat
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gz_course.sim.gz.sim.sdf.urdf.xacro_file import FILES, PLACE

_CPU_SECONDS = 10
_MEMORY = 2 * 1024**3
_MOST_ELEMENTS = 100_000


class _Places:
    """The opened files, and the element that xacro processed last."""

    def __init__(self) -> None:
        self.files: list[str] = []
        self.last: tuple[int, int] | None = None
        self.count = 0

    def handle(self, _operation: int, key: str, data: Any, _source: Any, copy: Any) -> None:
        """Copy the place of an element to its copy (called by the DOM)."""
        if copy is not None:
            self.count += 1
            if self.count > _MOST_ELEMENTS:
                raise ValueError(f"macros made more than {_MOST_ELEMENTS} elements; one may call itself without end")
            copy.setUserData(key, data, self)

    def seen(self, node: Any) -> None:
        """Record the element that an error would concern."""
        place = node.getUserData(PLACE)
        if place is not None:
            self.last = place

    def where(self) -> str:
        """Return `file:line` of the last recorded element."""
        return f"{self.files[self.last[0]]}:{self.last[1]}" if self.last else ""


def _builder(places: _Places, number: int) -> Any:
    class Builder(xml.dom.expatbuilder.ExpatBuilderNS):
        """A DOM builder that records the line number of each element."""

        def start_element_handler(self, name: str, attributes: list[str]) -> None:
            super().start_element_handler(name, attributes)
            self.curNode.setUserData(PLACE, (number, self.getParser().CurrentLineNumber), places)

    return Builder()


def expand(file: str, arguments: dict[str, str]) -> str:
    """Return the expanded XML text. Raises the errors of xacro, with file and line as a note."""
    import xacro

    places = _Places()

    def parse(inp: Any, filename: str | None = None) -> Any:
        if inp is not None or filename is None:
            raise ValueError("xacro parsed something that is no file")
        places.files.append(filename)
        try:
            with Path(filename).open("rb") as opened:
                return _builder(places, len(places.files) - 1).parseFile(opened)
        except OSError as error:
            places.files.pop()
            if xacro.filestack:
                xacro.filestack.pop()
            raise xacro.XacroException(f"the file '{filename}' cannot be read ({error.strerror})", exc=error) from None
        except xml.parsers.expat.ExpatError as error:
            places.last = (len(places.files) - 1, error.lineno)
            what = xml.parsers.expat.errors.messages.get(error.code, "malformed")
            raise ValueError(f"this is not well-formed XML ({what})") from None

    def watched(function: Callable[..., Any]) -> Callable[..., Any]:
        def wrapper(node: Any, *rest: Any) -> Any:
            places.seen(node)
            return function(node, *rest)

        return wrapper

    # xacro reports the file of an error but not the line; these functions are called for every element in turn.
    xacro.parse = parse
    for name in ("eval_all", "handle_macro_call", "check_attrs", "reqd_attrs"):
        setattr(xacro, name, watched(getattr(xacro, name)))
    try:
        document = xacro.process_file(file, mappings=arguments)
        root = document.documentElement
        _mark(root)
        root.setAttribute(FILES, json.dumps(places.files))
        return root.toxml()
    except (Exception, RecursionError) as error:
        error.add_note(places.where() or file)
        raise


def _mark(root: Any) -> None:
    waiting = [root]
    while waiting:
        node = waiting.pop()
        place = node.getUserData(PLACE)
        if place is not None:
            node.setAttribute(PLACE, f"{place[0]}:{place[1]}")
        waiting.extend(child for child in node.childNodes if child.nodeType == node.ELEMENT_NODE)


def _sentence(error: BaseException, file: str) -> str:
    where = getattr(error, "__notes__", [file])[0]
    if isinstance(error, RecursionError):
        return f"{where}: a macro or property calls itself without end"
    if isinstance(error, MemoryError):
        return f"{where}: xacro needs too much memory here"
    text = " ".join(str(error).split()) or type(error).__name__
    hint = ""
    missing = re.search(r"package '([^']*)' not found", text)
    if missing:
        return f"{where}: xacro: there is no ROS package '{missing[1]}'; is its prefix in AMENT_PREFIX_PATH?"
    if isinstance(getattr(error, "exc", None), OSError):
        text = str(error.args[0])
    elif isinstance(error, KeyError):
        text = f"{text} is not defined"
    if text.startswith("unknown macro name"):
        hint = "; is the file that defines it included before this line?"
    elif "Undefined substitution argument" in text:
        hint = "; declare it with <xacro:arg name='...' default='...'/>"
    return f"{where}: xacro: {text[:300]}{hint}"


def main(argv: list[str]) -> int:
    """Expand the file that the first argument names; return the exit code."""
    file, *pairs = argv
    resource.setrlimit(resource.RLIMIT_CPU, (_CPU_SECONDS, _CPU_SECONDS + 1))
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    arguments = dict(pair.split(":=", 1) for pair in pairs if ":=" in pair)
    try:
        with contextlib.redirect_stdout(sys.stderr):
            text = expand(file, arguments)
    except BaseException as error:  # every failure of xacro is reported in one sentence
        sys.stderr.write("\n" + json.dumps({"error": _sentence(error, file)}) + "\n")
        return 1
    sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
