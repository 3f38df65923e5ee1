"""The bridges of a YAML file, and its faults with file and line.

What the original ros_gz_bridge passes over (a misspelt key, a type without conversion, a repeated bridge) is an error
here, and the error knows what the original does (`Finding`). All errors of a file are reported at once.

Source: "Configuring the bridge via YAML" in README.md and src/bridge_config.cpp of ros_gz_bridge,
https://github.com/gazebosim/ros_gz; src/nodebuilder.cpp and convert.h of yaml-cpp 0.8
"""

from __future__ import annotations

import re
import stat
from dataclasses import dataclass, field, replace
from pathlib import Path

import yaml

from gz_course.sim.bridge.ros_gz_bridge.checks import check
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import KEYS, MISSING, SERVICE_KEYS, EntryReader, Value, unknown_key
from gz_course.sim.bridge.ros_gz_bridge.finding import ConfigError, Finding, raise_errors

MAX_BYTES = 256 * 1024
"""Maximum size of a YAML file [byte]."""
MAX_ENTRIES = 1000
"""Maximum number of bridges in a file."""
_SECOND_DOCUMENT = "a second document begins here, which is not read; write one list without '---' between its entries"


@dataclass
class Config:
    """The result of reading a configuration: the bridges that can be made, the errors and the warnings."""

    topics: list[BridgeEntry] = field(default_factory=list)
    services: list[ServiceEntry] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def add(self, entry: BridgeEntry | ServiceEntry | None) -> None:
        """Add a topic or a service; ignore None."""
        if isinstance(entry, ServiceEntry):
            self.services.append(entry)
        elif entry is not None:
            self.topics.append(entry)

    def include(self, other: Config) -> None:
        """Add bridges and findings of another configuration."""
        self.topics += other.topics
        self.services += other.services
        self.findings += other.findings

    def tolerant(self) -> Config:
        """Return the configuration as the original ros_gz_bridge takes it: without the bridges that cannot be made.

        Its errors are warnings.
        """
        broken = {each.place for each in self.findings if not (each.warning or each.tolerated)}
        return Config(
            [entry for entry in self.topics if entry.source not in broken],
            [entry for entry in self.services if entry.source not in broken],
            [replace(each, warning=True) for each in self.findings],
        )


def load_yaml(path: str | Path, *, lazy: bool = False) -> list[BridgeEntry]:
    """Return the topics of a YAML file. Raises ConfigError with all faults; a service counts as a fault.

    `lazy` is the default for entries without that key.
    """
    return topics_of(read_file(path, lazy=lazy))


def topics_of(config: Config) -> list[BridgeEntry]:
    """Return the topics. Raises ConfigError with all errors; a service counts as an error."""
    only_topics = "is a service; only topics can be bridged here"
    services = [Finding(entry.source, f"{entry.name} {only_topics}") for entry in config.services]
    raise_errors([*config.findings, *services])
    return config.topics


def read_file(path: str | Path, *, lazy: bool = False) -> Config:
    """Return the bridges and the faults of a YAML file; faults raise no exception."""
    path = Path(path)
    try:
        if not stat.S_ISREG(path.stat().st_mode) and not path.is_dir():  # reading from a pipe might never end
            return _only(str(path), "cannot read the bridge configuration: it is no ordinary file")
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        return _only(str(path), f"cannot read the bridge configuration: {reason}")
    return read_yaml(data, str(path), lazy=lazy)


def read_yaml(text: str | bytes, file_name: str = "<string>", *, lazy: bool = False) -> Config:
    """Return the bridges and the faults of a YAML text, like `read_file`."""
    first_line = f"{file_name}:1"
    if len(text) > MAX_BYTES:
        return _only(
            first_line, f"larger than {MAX_BYTES // 1024} KiB, which no bridge configuration needs", fatal=True
        )
    try:
        root, further = _documents(text, file_name)
    except ConfigError as error:
        place, _, sentence = error.errors[0].partition(": ")
        return _only(place, sentence, fatal=True)
    if root is None or (isinstance(root, yaml.ScalarNode) and root.tag.endswith(":null")):
        return _only(first_line, "the file is empty; expected a list of bridges, each starting with '- '")
    if not isinstance(root, yaml.SequenceNode):
        return _only(
            _place(file_name, root),
            f"expected a list of bridges, found {_shown(root)}; start each bridge with '- '",
        )
    if len(root.value) > MAX_ENTRIES:
        return _only(first_line, f"{len(root.value)} bridges, more than the {MAX_ENTRIES} a file may hold", fatal=True)
    config = Config()
    if further is not None:
        config.findings.append(Finding(_place(file_name, further), _SECOND_DOCUMENT, tolerated=True))
    for node in root.value:
        config.add(_entry(file_name, node, config.findings, lazy))
    if dash := _dash(file_name, root.value):
        finding, parts = dash
        caused = [each for each in config.findings if each.place in parts and f" {MISSING};" in each.sentence]
        ends = any(each.fatal for each in caused)
        config.findings = [each for each in config.findings if each not in caused]
        config.findings.append(replace(finding, fatal=ends, tolerated=finding.tolerated and not ends))
    config.findings.extend(check(config.topics, config.services))
    config.findings.sort(key=lambda finding: int(finding.place.rpartition(":")[2]))  # by line
    return config


def _dash(file_name: str, nodes: list[yaml.Node]) -> tuple[Finding, set[str]] | None:
    """Return the finding that a dash parts what is one bridge, and the places of the parts; None if no dash does."""
    keys = [_keys(node) for node in nodes]
    for above, one, below, other in zip(nodes, keys, nodes[1:], keys[1:], strict=False):
        if not (one and other and {*one, *other} <= {*KEYS}) or set(one) & set(other):
            continue
        if len(one) == len(other) == 1:  # no bridge has a single key
            sentence = (
                f"each dash begins another bridge, so '{one[0]}' and '{other[0]}' belong to two bridges here; write the"
                " dash before the first key of a bridge only, and its other keys below that one, with two spaces for "
                "the dash"
            )
            return Finding(_place(file_name, above), sentence), {_place(file_name, each) for each in nodes}
        if _complete([*one, *other]) and not (_complete(one) and _complete(other)):
            part = "what follows" if _complete(one) else "the one above"
            sentence = (
                f"the dash before '{other[0]}' begins another bridge, so {part} is a part of one; write two spaces in "
                "its place"
            )
            finding = Finding(_place(file_name, below), sentence, tolerated=_complete(other))
            return finding, {_place(file_name, above), _place(file_name, below)}
    return None


def _keys(node: yaml.Node) -> list[str]:
    pairs = node.value if isinstance(node, yaml.MappingNode) else []
    return [str(key.value) for key, _ in pairs if isinstance(key, yaml.ScalarNode)]


def _complete(keys: list[str]) -> bool:
    return {"ros_type_name", "gz_type_name"} <= {*keys} and any(key.endswith("topic_name") for key in keys)


def _only(place: str, sentence: str, *, fatal: bool = False) -> Config:
    return Config(findings=[Finding(place, sentence, fatal=fatal)])


def compose(text: str | bytes, file_name: str) -> yaml.Node | None:
    """Return the node tree of a YAML text with one document. Raises ConfigError with one sentence about anything else.

    The sentence begins with file and line; the nodes have line numbers; no object is constructed.
    """
    root, further = _documents(text, file_name)
    if further is not None:
        raise ConfigError([f"{_place(file_name, further)}: {_SECOND_DOCUMENT}"])
    return root


def _documents(text: str | bytes, file_name: str) -> tuple[yaml.Node | None, yaml.Node | None]:
    """Return the node trees of the first document of a YAML text and of the second, or None. Raises as `compose`."""
    try:
        documents = yaml.compose_all(text, Loader=yaml.SafeLoader)
        return next(documents, None), next(documents, None)
    except yaml.MarkedYAMLError as error:
        # An unfinished key or quotation is detected at its end: report its beginning.
        began = error.context in ("while scanning a simple key", "while scanning a quoted scalar")
        mark = (error.context_mark if began else None) or error.problem_mark or error.context_mark
        problem = " ".join((error.problem or error.context or "unreadable").split())
        hint = _hint(problem, text, mark.line if mark else 0)
        raise ConfigError([f"{file_name}:{mark.line + 1 if mark else 1}: not valid YAML: {problem}{hint}"]) from None
    except yaml.reader.ReaderError as error:
        line = _line_of(text, error.position)
        raise ConfigError([f"{file_name}:{line}: not a YAML text: {_unreadable(error)}"]) from None
    except RecursionError:
        raise ConfigError([f"{file_name}:1: nested too deeply for a bridge configuration"]) from None
    except (ValueError, OverflowError) as error:
        raise ConfigError([f"{file_name}:1: not valid YAML: {' '.join(str(error).split())}"]) from None


def _unreadable(error: yaml.reader.ReaderError) -> str:
    if error.encoding == "unicode":
        return str(error.reason)
    byte = error.character[0] if isinstance(error.character, bytes) else error.character
    return f"byte 0x{byte:02x} is not {error.encoding.upper()}; save the file as UTF-8"


def _hint(problem: str, text: str | bytes, line: int) -> str:
    """Return a hint that PyYAML's message lacks, from the line (counted from 0) where parsing stopped."""
    if problem == "found unexpected end of stream":
        return "; a quotation mark that opens here is never closed"
    lines = (text if isinstance(text, str) else text.decode(errors="replace")).splitlines()
    found = lines[line] if line < len(lines) else ""
    if "\\t" in problem or "\t" in found[: len(found) - len(found.lstrip())]:
        return "; YAML is indented with spaces, never with tabs"
    if re.match(r"\s*(- )?\w+:(?!//)\S", found):
        return "; a space is missing after the colon"
    if re.match(r"\s*-\w+:", found):
        return "; a space is missing after the dash"
    if re.match(r"\s*(- )?\w+\s*=", found):
        return "; between a key and its value stand a colon and a space, and no ="
    if re.match(r"\s*(- )?\w+: [^'\"#{\[]*: ", found):
        return "; two colons stand in this line: each key has a line of its own with its value"
    if re.match(r"\s*(- )?\w+: [@`%&*!|>]", found):
        return "; a value that begins with such a sign needs quotation marks"
    if found.startswith("- ") and "document start" in problem:
        return "; the dash of the first entry, above, is missing"
    if "{" in found or "[" in found or "}" in found:
        return _in_braces(problem, found)
    before = next((n for n in range(line - 1, -1, -1) if lines[n].split("#")[0].strip()), None)
    if problem == "mapping values are not allowed here" and before is not None:
        if re.match(r"\s*-\w+:", lines[before]):
            return f"; a space is missing after the dash in line {before + 1}"
        if re.match(r"\s*(- )?\w+:\S", lines[before]):
            return f"; a space is missing after the colon in line {before + 1}"
        if ":" not in lines[before]:
            return f"; there is no colon in line {before + 1}"
        if _column(lines[before]) < _column(found):
            return f"; it is indented further than line {before + 1}"
    return ""


def _in_braces(problem: str, found: str) -> str:
    """Return a hint about a line with braces or brackets."""
    if "expected ','" in problem and "got ':'" in problem:
        return "; a comma is missing between two keys in these braces"
    if "expected ','" in problem:
        return "; a brace or bracket that opens before this place is never closed"
    if found.count("}") > found.count("{") or found.count("]") > found.count("["):
        return "; it closes a brace or bracket that nothing has opened"
    return ""


def _column(line: str) -> int:
    """Return the column in which the key of a line begins, after a dash."""
    return len(line) - len(line.lstrip(" -"))


def _line_of(text: str | bytes, position: int) -> int:
    before = text[:position]
    return 1 + (before.count(b"\n") if isinstance(before, bytes) else before.count("\n"))


def _entry(file_name: str, node: yaml.Node, findings: list[Finding], lazy: bool) -> BridgeEntry | ServiceEntry | None:
    place = _place(file_name, node)
    if not isinstance(node, yaml.MappingNode):
        findings.append(Finding(place, f"expected a bridge (lines of 'key: value'), found {_shown(node)}"))
        return None
    values: dict[str, Value] = {}
    first_line: dict[str, int] = {}
    no_dash = False
    keys = [key_node.value for key_node, _ in node.value if isinstance(key_node, yaml.ScalarNode)]
    for number, (key_node, value_node) in enumerate(node.value):
        key = key_node.value if isinstance(key_node, yaml.ScalarNode) else None
        here = _place(file_name, key_node)
        if key is None or key not in (*KEYS, *SERVICE_KEYS):
            findings.append(Finding(here, unknown_key(key), tolerated=True))
        elif key in first_line:
            several = sum(other in first_line for other in keys[number:]) > 1
            if no_dash:
                continue
            no_dash = several
            sentence = f"'{key}' is given twice (first in line {first_line[key]}, which counts); " + (
                f"so are those below it: a dash is missing here, '- {key}:' begins the next bridge"
                if several
                else "keep one, or write '- ' before it if another bridge begins here"
            )
            findings.append(Finding(here, sentence, tolerated=True))
        else:
            first_line[key] = key_node.start_mark.line + 1
            values[key] = _value(file_name, value_node)
    return EntryReader(place, values, findings, lazy).read()


def _value(file_name: str, node: yaml.Node) -> Value:
    place = _place(file_name, node)
    if not isinstance(node, yaml.ScalarNode):
        return Value(place, "structure", "", _shown(node))
    kinds = {"null": "null", "bool": "bool", "int": "int", "float": "float"}
    prefix, _, name = node.tag.rpartition(":")
    if not prefix.startswith("tag:yaml.org") or node.tag.startswith("tag:yaml.org,2002:python"):
        return Value(place, "structure", "", f"something tagged {node.tag[:60]}")
    return Value(place, kinds.get(name, "text"), node.value, _shown(node))


def _place(file_name: str, node: yaml.Node) -> str:
    return f"{file_name}:{node.start_mark.line + 1}"


def _shown(node: yaml.Node) -> str:
    if isinstance(node, yaml.MappingNode):
        return "a mapping ('key: value')"
    if isinstance(node, yaml.SequenceNode):
        return "a list"
    return "nothing" if node.tag.endswith(":null") or not node.value else f"the text '{node.value[:60]}'"
