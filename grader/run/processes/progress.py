"""What a process of the submission reports about itself, its counts and its endpoints, parsed as untrusted input."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, fields
from typing import Any


@dataclass(frozen=True)
class Endpoint:
    """A publisher or subscription of one of the student's nodes."""

    node: str
    kind: str  # publisher | subscription
    topic: str
    type: str
    reliability: str
    durability: str
    matched: int

    @property
    def identity(self) -> tuple[str, ...]:
        """All of it but how many it has matched."""
        return (self.node, self.kind, self.topic, self.type, self.reliability, self.durability)


@dataclass(frozen=True)
class Progress:
    """The latest report of a process about itself. Untrusted."""

    clock: int | None = None  # [ns] simulated time its nodes have seen; None: none follows /clock
    idle: bool = True  # all its executors are asleep, or it waits for an answer
    taken: dict[str, int] = field(default_factory=dict)
    published: dict[str, int] = field(default_factory=dict)
    delivered: dict[str, int] = field(default_factory=dict)  # as `published`, times the number of readers
    holding: bool = False  # whether it keeps what it sends until ordered to release it
    held: int = 0  # messages that wait to be released
    released: int = 0
    flushes: int = 0  # how often it has asked for the confirmation that everything arrived
    logged: int = 0  # messages its nodes have sent to /rosout
    again: frozenset[str] = frozenset()  # topics on which it expects that a message may come twice
    spun: bool = False  # whether an executor of it has ever waited
    wakes: int | None = None  # [ns] of simulated time at which its first sleeper is due
    woken: int = 0  # orders to wake a sleeper that it carried out
    blocked: bool = False  # one of its nodes cannot take messages at the moment: a callback sleeps, or nobody spins it
    lost: dict[str, int] = field(default_factory=dict)  # published before anybody had found the publisher
    # topic -> [ns] of real time: what it published earlier is only for those who join late and ask for it
    found_at: dict[str, int] = field(default_factory=dict)
    kept: dict[str, int] = field(default_factory=dict)  # "TOPIC TYPE" -> messages that publishers keep for late joiners
    asked: dict[str, int] = field(default_factory=dict)  # the same -> subscriptions that take them when they come
    endpoints: tuple[Endpoint, ...] = ()

    @staticmethod
    def parse(data: bytes, before: Progress | None) -> Progress | None:
        """Parse a report; return None if it is not one. Endpoints it does not mention are as `before`."""
        try:
            raw = json.loads(data)
            clock = raw["clock"]
            return Progress(
                clock=None if clock is None else _count(clock),
                idle=raw["idle"] is True,
                taken=_counts(raw["taken"]),
                published=_counts(raw["published"]),
                delivered=_counts(raw["delivered"]),
                holding=raw["holding"] is True,
                held=_count(raw["held"]),
                released=_count(raw["released"]),
                flushes=_count(raw["flushes"]),
                logged=_count(raw.get("logged", 0)),
                again=frozenset(map(str, raw.get("again", ()))),
                spun=raw.get("spun") is True,
                wakes=_count(raw["wakes"]) if "wakes" in raw else None,
                woken=_count(raw.get("woken", 0)),
                blocked=raw.get("blocked") is True,
                lost=_counts(raw.get("lost", {})),
                found_at=_counts(raw.get("found_at", {})),
                kept=_counts(raw.get("kept", {})),
                asked=_counts(raw.get("asked", {})),
                endpoints=tuple(_endpoint(e) for e in raw["endpoints"])
                if "endpoints" in raw
                else before.endpoints
                if before
                else (),
            )
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            return None


def _counts(raw: dict[Any, Any]) -> dict[str, int]:
    return {str(name): _count(number) for name, number in raw.items()}


def _count(value: Any) -> int:
    if type(value) is not int:
        raise TypeError(f"{value!r} is no count")
    return value


def _endpoint(raw: dict[str, Any]) -> Endpoint:
    endpoint = Endpoint(**raw)
    for each in fields(Endpoint):
        if type(getattr(endpoint, each.name)) is not (int if each.name == "matched" else str):
            raise TypeError(f"{each.name} of an endpoint is {getattr(endpoint, each.name)!r}")
    return endpoint
