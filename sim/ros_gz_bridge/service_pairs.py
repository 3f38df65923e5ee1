"""Which ROS service type stands for which Gazebo service: the table of service pairs.

A Gazebo service is offered as a ROS service, never the other way round, as in ros_gz_bridge. A pair is declared
with ``@service_pair(...)`` in ``convert/<ros package>.py`` beside the type pairs of that package, and so enters
the table when the package can be imported. ``service_link`` asks here for the conversions of an entry.
"""

from __future__ import annotations

import difflib
import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from gz.msgs import message_class
from ros_gz_bridge.type_pairs import (
    MissingPackageError,
    UnknownPairError,
    canonical_gz_type,
    convertible_packages,
    missing_packages,
    pairs,
)


@dataclass(frozen=True)
class ServicePair:
    """One ROS service type, the two Gazebo types behind it and the functions between them.

    ``to_gz`` makes the Gazebo request from the ROS request; ``to_ros`` makes the ROS response from Gazebo's
    reply; ``failed`` makes the ROS response for a call that Gazebo did not answer.
    """

    ros_type: str
    gz_req_type: str
    gz_rep_type: str
    ros_class: Any
    gz_req_class: Any
    gz_rep_class: Any
    to_gz: Callable[[Any], Any]
    to_ros: Callable[[Any], Any]
    failed: Callable[[], Any]


_pairs: dict[tuple[str, str, str], ServicePair] = {}


def service_pair(ros_type: str, gz_req_type: str, gz_rep_type: str) -> Callable[[type], type]:
    """Class decorator: declare the static methods ``to_gz``, ``to_ros`` (perhaps ``failed``) as a service pair.

    Without ``failed`` the response to a failed call is the ROS type's default one. Raises ``ValueError`` if the
    three types are already a pair.
    """

    def declare(conversions: Any) -> Any:
        package, _, name = ros_type.split("/")
        ros_class = getattr(importlib.import_module(f"{package}.srv"), name)
        key = (ros_type, gz_req_type, gz_rep_type)
        if key in _pairs:
            raise ValueError(f"the service pair {ros_type} = {gz_req_type}, {gz_rep_type} is declared twice")
        _pairs[key] = ServicePair(
            *key,
            ros_class,
            message_class(gz_req_type),
            message_class(gz_rep_type),
            conversions.to_gz,
            conversions.to_ros,
            getattr(conversions, "failed", ros_class.Response),
        )
        return conversions

    return declare


def service_pairs() -> list[ServicePair]:
    """Every service pair that can be used here, sorted by ROS type."""
    pairs()  # loads the files of convert/
    return [_pairs[key] for key in sorted(_pairs)]


def find_service_pair(ros_type: str, gz_req_type: str = "", gz_rep_type: str = "") -> ServicePair:
    """The pair of these types; without Gazebo types, the first one of the ROS type.

    Raises ``MissingPackageError`` when the ROS package is not installed and ``UnknownPairError``, naming the
    nearest pair, when there is no such pair.
    """
    gz_req_type, gz_rep_type = canonical_gz_type(gz_req_type), canonical_gz_type(gz_rep_type)
    known = service_pairs()
    candidates = [pair for pair in known if pair.ros_type == ros_type]
    for pair in candidates:
        if (gz_req_type, gz_rep_type) in ((pair.gz_req_type, pair.gz_rep_type), ("", "")):
            return pair
    if candidates:
        first = candidates[0]
        raise UnknownPairError(
            f"{ros_type} cannot call a service of {gz_req_type or 'nothing'} and {gz_rep_type or 'nothing'}; it pairs "
            f"with {first.gz_req_type} and {first.gz_rep_type}"
        )
    package = ros_type.split("/")[0]
    if package in convertible_packages() and package in missing_packages():
        raise MissingPackageError(f"the type {ros_type} needs the ROS package {package}, which is not installed")
    nearest = difflib.get_close_matches(ros_type, [pair.ros_type for pair in known], n=1)
    hint = f"; did you mean {nearest[0]}?" if nearest else ""
    raise UnknownPairError(f"no conversion is known for the service type {ros_type}{hint}")
