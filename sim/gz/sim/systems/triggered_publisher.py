"""TriggeredPublisher: publishes messages in response to a message.

If a message of `<input type= topic=>` fulfils every `<match>`, every `<output type= topic=>` is published after
`<delay_ms>` [ms] of simulated time. A match is the text of a whole message, or of one field with `field="a.b"`;
`logic_type="negative"` inverts it, `tol` is the tolerance of numbers.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/triggered_publisher/TriggeredPublisher.cc
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from google.protobuf.message import Message

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.msgs.registry import UnknownTypeError
from gz_course.sim.gz.msgs.text import MessageTextError, from_text
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_MOST = 10_000
"""Maximum number of delayed outputs; the oldest ones are dropped."""


@dataclass(frozen=True)
class _Match:
    """A value that a message, or its field at `path`, is compared with."""

    wanted: Message
    path: tuple[str, ...]
    tolerance: float
    positive: bool

    def accepts(self, message: Message) -> bool:
        """Tell whether a message of the right type matches."""
        return self._same(message) == self.positive

    def _same(self, message: Message) -> bool:
        wanted: Any = self.wanted
        given: Any = message
        for name in self.path[:-1]:
            wanted, given = getattr(wanted, name), getattr(given, name)
        if not self.path:
            return _equal(wanted, given, self.tolerance)
        field = wanted.DESCRIPTOR.fields_by_name[self.path[-1]]
        ours, theirs = getattr(wanted, field.name), getattr(given, field.name)
        if field.is_repeated:
            # As in Gazebo the wanted elements must be present in any order; others are allowed.
            return all(any(_equal(each, other, self.tolerance) for other in theirs) for each in ours)
        if field.message_type is not None and wanted.HasField(field.name) != given.HasField(field.name):
            return False
        return _equal(ours, theirs, self.tolerance)


def _equal(one: Any, other: Any, tolerance: float) -> bool:
    """Compare two values of the same field; an unset field differs from a set one."""
    if isinstance(one, float):
        return one == other or abs(one - other) <= tolerance or (one != one and other != other)
    if not isinstance(one, Message):
        return bool(one == other)
    ours, theirs = ({field.name: (field, value) for field, value in each.ListFields()} for each in (one, other))
    for name in ours.keys() | theirs.keys():
        field = (ours.get(name) or theirs[name])[0]
        if field.is_repeated:
            pair = list(getattr(one, name)), list(getattr(other, name))
            if len(pair[0]) != len(pair[1]):
                return False
            if not all(_equal(a, b, tolerance) for a, b in zip(*pair, strict=True)):
                return False
            continue
        if field.message_type is not None and one.HasField(name) != other.HasField(name):
            return False
        if not _equal(getattr(one, name), getattr(other, name), tolerance):
            return False
    return True


@system("TriggeredPublisher", "gz-sim-triggered-publisher-system")
class TriggeredPublisher(System):
    """A system of a world or a model with one input and any number of outputs."""

    parameters = frozenset(("input", "output", "delay_ms", "service"))
    joins_topics = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read input, matches and outputs. Raises SdfError for unknown types and invalid texts."""
        element = plugin.element
        self.world = world
        given = element.find("input")
        if given is None:
            raise element.error("TriggeredPublisher needs an <input type=... topic=...>, none was found")
        self._input_type = _type(given)
        self.input_topic = _topic(given)
        self._matches = [_match(child, self._input_type) for child in given.all("match") if child.text]
        self._outputs = [(_topic(child), _message(child.text, _type(child), child)) for child in element.all("output")]
        if not self._outputs:
            raise element.error("TriggeredPublisher needs at least one <output type=... topic=...>, none was found")
        self._delay_ns = max(0, element.integer("delay_ms", 0)) * 1_000_000
        service = element.find("service")
        if service is not None:
            text = "TriggeredPublisher does not call services here, <service> is left out"
            world.diagnostics.warn(service.where, text)
        self._publishers: list[Any] = []

    def start(self) -> None:
        self._due: deque[int] = deque(maxlen=_MOST)

    def connect(self, node: Node) -> None:
        topics: dict[str, Any] = {}
        for topic, message in self._outputs:
            if topic not in topics:
                topics[topic] = node.advertise(topic, type(message))
        self._publishers = [partial(topics[topic].publish, message) for topic, message in self._outputs]
        node.subscribe(self._input_type, self.input_topic, self._on_input)

    def _on_input(self, message: Message) -> None:
        if not all(match.accepts(message) for match in self._matches):
            return
        if self._delay_ns:
            self._due.append(self.world.sim_time_ns + self._delay_ns)
        else:
            self._answer()

    def _answer(self) -> None:
        for publish in self._publishers:
            publish()

    def pre_update(self, info: UpdateInfo) -> None:
        """Publish the outputs whose delay has passed."""
        while self._due and self._due[0] <= info.sim_time_ns:
            self._due.popleft()
            self._answer()


def _type(element: Element) -> type[Message]:
    name = element.attributes.get("type", "")
    if not name:
        raise element.error(f"TriggeredPublisher's <{element.tag}> needs a type, such as type='gz.msgs.Twist'")
    try:
        return message_class(name)
    except UnknownTypeError as error:
        raise element.error(str(error)) from None


def _topic(element: Element) -> str:
    name = element.attributes.get("topic", "")
    if not name.strip(" /"):
        raise element.error(f"TriggeredPublisher's <{element.tag}> needs a topic, such as topic='/start'")
    return valid_topic(name)


def _message(text: str, kind: type[Message], element: Element) -> Message:
    try:
        return from_text(text, kind)
    except MessageTextError as error:
        raise element.error(f"TriggeredPublisher's <{element.tag}> does not fit: {error}") from None


def _match(element: Element, kind: type[Message]) -> _Match:
    attributes = element.attributes
    logic = attributes.get("logic_type", "positive")
    if logic not in ("positive", "negative"):
        raise element.error(f"TriggeredPublisher's logic_type must be positive or negative, got '{logic}'")
    try:
        tolerance = float(attributes.get("tol", "1e-8"))
    except ValueError:
        raise element.error(f"TriggeredPublisher's tol must be a number, got '{attributes['tol']}'") from None
    path = tuple(part for part in attributes.get("field", "").split(".") if part)
    text = element.text
    descriptor: Any = kind.DESCRIPTOR
    for depth, name in enumerate(path):
        field = descriptor.fields_by_name.get(name)
        last = depth == len(path) - 1
        if field is None or (not last and (field.message_type is None or field.is_repeated)):
            what = "no field" if field is None else "no single message in field"
            raise element.error(
                f"{descriptor.full_name} has {what} '{name}', which <match field='{'.'.join(path)}'> names"
            )
        if last:
            # Protobuf's text format: a message in braces, a number or a word as it is.
            bare = text.strip()
            text = f"{name} {{{bare.strip('{}')}}}" if field.message_type is not None else f"{name}: {bare}"
        else:
            descriptor = field.message_type
    for name in reversed(path[:-1]):
        text = f"{name} {{{text}}}"
    return _Match(_message(text, kind, element), path, tolerance, logic == "positive")
