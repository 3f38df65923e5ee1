"""A service of this process: its types, and how its callback is called.

Requests come from the same process (in the requester's thread) or from other processes (in a service thread). An
exception or a wrong return value of the callback prints one line on stderr and is a failed call for the requester.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from google.protobuf.message import DecodeError, Message

from gz_course.sim.gz.msgs import canonical_name
from gz_course.sim.gz.msgs.fortress import same_type
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.options import Scope
from gz_course.sim.gz.transport.subscription import one_line

EMPTY_TYPE = "gz.msgs.Empty"
"""The response type of one-way services."""


class CallResult(NamedTuple):
    """The outcome of a request."""

    executed: bool
    """False if no response arrived in time."""
    result: bool
    """The result reported by the provider; False for a failure."""
    response: bytes
    """The serialized response; empty if `result` is False."""


TIMED_OUT = CallResult(False, False, b"")
FAILED = CallResult(True, False, b"")


class Service:
    """A callback with the name of its service and its types."""

    def __init__(
        self,
        name: str,
        request_class: type[Message],
        response_class: type[Message],
        request_type: str,
        response_type: str,
        node_uuid: str,
        scope: Scope,
        callback: Callable[[Any], Any],
    ) -> None:
        """`name` is fully qualified; types are announced under the given names. Use Node.advertise_service()."""
        self.name = name
        self.topic = naming.split(name)[1]
        self.request_type = request_type
        self.response_type = response_type
        self.node_uuid = node_uuid
        self.scope = scope
        self._request_class = request_class
        self._response_class = response_class
        self._callback = callback

    @property
    def one_way(self) -> bool:
        return is_one_way(self.response_type)

    def matches(self, request_type: str, response_type: str) -> bool:
        """Return whether a request with these types is meant for this service."""
        return same_types(self.request_type, self.response_type, request_type, response_type)

    def answer(self, data: bytes) -> CallResult:
        """Call the callback with the request; raises no Exception."""
        try:
            request = self._request_class.FromString(data)
        except DecodeError:
            return FAILED
        try:
            returned = self._callback(request)
        except Exception as error:
            complain(f"The callback of service [{self.topic}] {one_line(error)}")
            return FAILED
        if self.one_way:
            return CallResult(True, True, b"")
        return self._outcome(returned)

    def _outcome(self, returned: Any) -> CallResult:
        result, response = True, returned
        if isinstance(returned, tuple) and len(returned) == 2:
            result, response = bool(returned[0]), returned[1]
            if not result:
                return FAILED
        if not isinstance(response, self._response_class):
            complain(
                f"The callback of service [{self.topic}] returned {type(response).__name__}, but a "
                f"{self.response_type} or (bool, {self.response_type}) was expected; the request has failed."
            )
            return FAILED
        try:
            return CallResult(True, True, response.SerializeToString())
        except Exception as error:
            complain(f"The response of service [{self.topic}] cannot be serialized: {error}")
            return FAILED


def is_one_way(response_type: str) -> bool:
    """Return whether this response type makes a service one-way."""
    return canonical_name(response_type) == EMPTY_TYPE


def same_types(request: str, response: str, other_request: str, other_response: str) -> bool:
    """Return whether two pairs of type names are equal, where `ignition.msgs.X` equals `gz.msgs.X`."""
    return same_type(request, other_request) and same_type(response, other_response)
