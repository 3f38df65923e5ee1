"""The endpoints of the submission as facts of its recording: what its processes report, if DDS has seen it, too.

A report says when an endpoint came and what its node asked for; DDS says whether it exists. What is there and was not
reported (a node that nobody spins, a process without the agent) is a fact as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, replace
from typing import Any

from gz_course.grader.run.agent.course_agent.executor_monitor import HOUSEKEEPING
from gz_course.grader.run.discovery import UNKNOWN, Discovery
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.processes.progress import Endpoint

NAMES = 5.0  # [s] for reported endpoints, and for the names of nodes, to be discovered
MOST_LOOKS = 200  # for what was reported
MOST = 2_000  # endpoints that are kept of what was reported

Key = tuple[str, str, str, str]


class EndpointFacts:
    """Collects the endpoints of one run. `offered_reliably(topic)`: whether the grader publishes so there."""

    def __init__(self, discovery: Discovery, offered_reliably: Callable[[str], bool]) -> None:
        self._discovery = discovery
        self._offered_reliably = offered_reliably
        self._reported: dict[Key, Endpoint] = {}
        self._seen: dict[Key, Endpoint] = {}
        self._refused: set[Key] = set()
        self._looks = 0  # that are left until more is reported

    def report(self, endpoints: Iterable[Endpoint]) -> None:
        """Take what processes report, and look which of that DDS has seen already."""
        for each in endpoints:
            if len(self._reported) < MOST and each.topic not in HOUSEKEEPING:
                self._reported.setdefault(_key(each), each)
        self._looks = MOST_LOOKS
        self.look()

    def look(self) -> None:
        """Look for what was reported and not seen; discovery takes a moment, and an endpoint may not stay long."""
        if self._looks and self._reported.keys() - self._seen.keys():
            self._looks -= 1
            self._look()

    def close(self, present: Iterable[Endpoint], clock: FairClock, wait: Callable[[], object]) -> None:
        """Take the endpoints that exist at the end. Of those reported `present`, only what DDS has seen is kept.

        `wait()` is called between two looks.
        """
        expected = {_key(each) for each in present if each.topic not in HOUSEKEEPING}
        patience = Patience(clock, NAMES)
        while self._look() or expected - self._seen.keys():
            if patience.over():
                break
            wait()
        self._refused = expected - self._seen.keys()

    def as_facts(self) -> list[dict[str, Any]]:
        """Return all of them for the recording, sorted."""
        found = self._reported | self._seen
        # Whether it had matched yet when it was first seen differs between equal runs.
        return [asdict(found[key]) | {"matched": None} for key in sorted(found.keys() - self._refused)]

    def _look(self) -> bool:
        """Note what DDS shows; return whether the name of a node is not known yet."""
        unknown = False
        for each in self._discovery.endpoints():
            unknown |= each.node == UNKNOWN
            if each.node != UNKNOWN:
                self._seen.setdefault(_key(each), self._as_asked(each))
        return unknown

    def _as_asked(self, seen: Endpoint) -> Endpoint:
        """Return an endpoint with the reliability its node asked for, where the agent asks for more."""
        asked = self._reported.get(_key(seen))
        patched = seen.kind == "subscription" and self._offered_reliably(seen.topic)
        if asked is None or not patched or asked.reliability != "BEST_EFFORT":
            return seen
        return replace(seen, reliability=asked.reliability)


def _key(endpoint: Endpoint) -> Key:
    return (endpoint.kind, endpoint.topic, endpoint.type, endpoint.node)
