"""The options of gz-transport for nodes, publishers, services and subscriptions, as plain values."""

from __future__ import annotations

import copy
import enum
from typing import TypeVar

from gz_course.sim.gz.transport import environment, naming

UNTHROTTLED = 2**64 - 1
"""The rate that means "no limit" in the protocol."""


class Scope(enum.IntEnum):
    """The processes that a publisher or service reaches; the numbers are those of the protocol.

    Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/discovery.proto (Scope)
    """

    PROCESS = 0
    HOST = 1
    ALL = 2


def _checked_rate(rate: int) -> int:
    if isinstance(rate, bool) or not isinstance(rate, int) or not 1 <= rate <= UNTHROTTLED:
        raise ValueError(f"msgs_per_sec is {rate!r}, but a whole number from 1 to 2**64 - 1 was expected.")
    return rate


def _checked_name(name: str, what: str, present: str) -> str:
    try:
        return naming.check(name, what, may_be_empty=True)
    except ValueError as error:
        environment.complain(f"{error} It stays {present!r}.")
        return present


Options = TypeVar("Options", bound="_Options")


class _Options:
    """Common base of all options: copying, and comparison by value."""

    def __copy__(self: Options) -> Options:
        other = type(self).__new__(type(self))
        vars(other).update({name: copy.copy(value) for name, value in vars(self).items()})
        return other

    def __deepcopy__(self: Options, memo: dict[int, object]) -> Options:
        return self.__copy__()

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        values = ", ".join(f"{name.removeprefix('_')}={value!r}" for name, value in vars(self).items())
        return f"{type(self).__name__}({values})"


class AdvertiseOptions(_Options):
    """Options of publishers and services: a scope, and (not in the official binding) `fortress`."""

    def __init__(self, scope: Scope | AdvertiseOptions = Scope.ALL, fortress: bool = False) -> None:
        """Set the values, or copy other options.

        With `fortress` the types are announced under their Fortress names `ignition.msgs.X`, which tools and bridges of
        Fortress understand and newer ones do not.
        """
        other = scope if isinstance(scope, AdvertiseOptions) else None
        self.scope = Scope(scope) if other is None else other.scope  # type: ignore[arg-type]
        self.fortress: bool = fortress if other is None else other.fortress

    @property
    def scope(self) -> Scope:
        """Return the reach: this process, this machine, or all machines."""
        return self._scope

    @scope.setter
    def scope(self, scope: Scope) -> None:
        self._scope = Scope(scope)


class AdvertiseServiceOptions(AdvertiseOptions):
    """The scope of a service, and `fortress`; a type of its own as in the official binding."""


class AdvertiseMessageOptions(AdvertiseOptions):
    """Options of a publisher: its scope and its maximum message rate."""

    def __init__(
        self,
        scope: Scope | AdvertiseMessageOptions = Scope.ALL,
        msgs_per_sec: int = UNTHROTTLED,
        fortress: bool = False,
    ) -> None:
        super().__init__(scope, fortress)
        self.msgs_per_sec = scope.msgs_per_sec if isinstance(scope, AdvertiseMessageOptions) else msgs_per_sec

    @property
    def msgs_per_sec(self) -> int:
        """Return the maximum number of sent messages per second; the rest is dropped. UNTHROTTLED means no limit."""
        return self._msgs_per_sec

    @msgs_per_sec.setter
    def msgs_per_sec(self, rate: int) -> None:
        self._msgs_per_sec = _checked_rate(rate)

    @property
    def throttled(self) -> bool:
        return self._msgs_per_sec != UNTHROTTLED


class SubscribeOptions(_Options):
    """Options of a subscription: the maximum message rate, and whether messages of its own node are delivered."""

    def __init__(self, msgs_per_sec: int | SubscribeOptions = UNTHROTTLED, ignore_local_messages: bool = False) -> None:
        if isinstance(msgs_per_sec, SubscribeOptions):
            vars(self).update(vars(msgs_per_sec))
            return
        self.msgs_per_sec = msgs_per_sec
        self.ignore_local_messages = ignore_local_messages

    @property
    def msgs_per_sec(self) -> int:
        """Return the maximum number of delivered messages per second; the rest is dropped. UNTHROTTLED means no
        limit.
        """
        return self._msgs_per_sec

    @msgs_per_sec.setter
    def msgs_per_sec(self, rate: int) -> None:
        self._msgs_per_sec = _checked_rate(rate)

    @property
    def throttled(self) -> bool:
        return self._msgs_per_sec != UNTHROTTLED


class NodeOptions(_Options):
    """Options of a node: partition, namespace, topic remappings; and, not in the official binding, scope and
    `synchronous`.

    With `scope=Scope.PROCESS` the node uses no socket and no thread, and communicates only within its process. With
    `synchronous`, which that scope includes, the callbacks of its subscriptions run in the publisher's thread before
    publish() returns, if the publisher is in this process; in Gazebo, and by default, they run in a thread of their
    own. As in the official binding a property is left as it was, with a line on stderr, if a new value is not valid;
    the constructor raises ValueError.
    """

    def __init__(
        self,
        partition: str | NodeOptions | None = None,
        namespace: str = "",
        scope: Scope = Scope.ALL,
        synchronous: bool = False,
    ) -> None:
        if isinstance(partition, NodeOptions):
            vars(self).update(vars(partition.__copy__()))
            return
        partition = environment.default_partition() if partition is None else partition
        self._partition = naming.check(partition, "partition", may_be_empty=True)
        self._namespace = naming.check(namespace, "namespace", may_be_empty=True)
        self.scope = Scope(scope)
        self.synchronous = synchronous or self.scope == Scope.PROCESS
        self._remappings: dict[str, str] = {}

    @property
    def partition(self) -> str:
        """Return the partition; nodes communicate only within one. Default: GZ_PARTITION or `<host name>:<user>`."""
        return self._partition

    @partition.setter
    def partition(self, partition: str) -> None:
        self._partition = _checked_name(partition, "partition", self._partition)

    @property
    def namespace(self) -> str:
        """Return the prefix of every topic that does not start with `/`."""
        return self._namespace

    @namespace.setter
    def namespace(self, namespace: str) -> None:
        self._namespace = _checked_name(namespace, "namespace", self._namespace)

    def add_topic_remap(self, from_topic: str, to_topic: str) -> bool:
        """Remap `from_topic` to `to_topic`; return False if `from_topic` already is remapped or a name is not valid."""
        for name in (from_topic, to_topic):
            if (rule := naming.broken_rule(name, may_be_empty=False)) is not None:
                environment.complain(f"The topic {from_topic!r} is not remapped: the name {name!r} {rule}.")
                return False
        if from_topic in self._remappings:
            return False
        self._remappings[from_topic] = to_topic
        return True

    def topic_remap(self, from_topic: str) -> tuple[bool, str]:
        """Return (True, the remapped name), or (False, "") if `from_topic` is not remapped."""
        return from_topic in self._remappings, self._remappings.get(from_topic, "")

    def renamed(self, topic: str) -> str:
        """Return the remapped name of `topic`, or `topic` itself."""
        return self._remappings.get(topic, topic)

    def qualified(self, topic: str, what: str = "topic") -> str:
        """Return the fully qualified name of a topic or service of the node. Raises ValueError if it is invalid."""
        return naming.fully_qualified(self.partition, self.namespace, self.renamed(topic), what)

    def copy(self) -> NodeOptions:
        """Return an independent copy, so that later changes of the original do not affect the node."""
        return self.__copy__()
