"""The environment variables of gz-transport, with the defaults of this course.

They are read once per node (partition) and once per process (addresses and ports). One default differs from
gz-transport: without GZ_IP all traffic stays on 127.0.0.1, so that a robot on another machine cannot be driven by
mistake. To reach other machines, set GZ_IP to the address of this one.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc
Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeOptions.cc
"""

from __future__ import annotations

import ipaddress
import os
import pwd
import socket
import sys
import uuid
from collections.abc import Mapping
from dataclasses import dataclass

DEFAULT_IP = "127.0.0.1"
DEFAULT_GROUP = "239.255.0.7"
DEFAULT_MESSAGE_PORT = 10317
DEFAULT_SERVICE_PORT = 10318
DEFAULT_HIGH_WATER_MARK = 1000
_NOT_IMPLEMENTED = (
    "GZ_RELAY",
    "GZ_TRANSPORT_USERNAME",
    "GZ_TRANSPORT_PASSWORD",
)


def complain(sentence: str) -> None:
    """Print one line on stderr, in threads where an exception would not reach the user."""
    print(f"[gz.transport] {sentence}", file=sys.stderr, flush=True)


def default_partition(environment: Mapping[str, str] | None = None) -> str:
    """Return GZ_PARTITION if it is set (even empty), otherwise `<host name>:<user>`."""
    environment = os.environ if environment is None else environment
    if "GZ_PARTITION" in environment:
        return environment["GZ_PARTITION"]
    return f"{socket.gethostname()}:{_user(environment)}"


def _user(environment: Mapping[str, str]) -> str:
    if environment.get("USER"):
        return environment["USER"]
    try:
        return pwd.getpwuid(os.getuid()).pw_name
    except KeyError:  # a uid without an account, common in containers
        complain(
            f"The user id {os.getuid()} has no name, so this process has a partition of its own "
            "and finds nobody; set USER or GZ_PARTITION."
        )
        return f"error-{uuid.uuid4()}"


@dataclass(frozen=True)
class NetworkSettings:
    """Addresses, ports and queue lengths of one process."""

    ip: str = DEFAULT_IP
    group: str = DEFAULT_GROUP
    message_port: int = DEFAULT_MESSAGE_PORT
    service_port: int = DEFAULT_SERVICE_PORT
    send_high_water_mark: int = DEFAULT_HIGH_WATER_MARK
    receive_high_water_mark: int = DEFAULT_HIGH_WATER_MARK
    topic_statistics: bool = False

    @classmethod
    def from_environment(cls, environment: Mapping[str, str] | None = None) -> NetworkSettings:
        """Return the settings; an invalid value is reported on stderr and replaced by its default, as in gz."""
        environment = os.environ if environment is None else environment
        for name in _NOT_IMPLEMENTED:
            if environment.get(name, "") not in ("", "0"):
                complain(f"{name} is set, but this gz-transport does not support it; it is ignored.")
        message_port = _number(environment, "GZ_DISCOVERY_MSG_PORT", DEFAULT_MESSAGE_PORT, 1, 65535)
        service_port = _number(environment, "GZ_DISCOVERY_SRV_PORT", DEFAULT_SERVICE_PORT, 1, 65535)
        if service_port == message_port:
            service_port += 1 if service_port < 65535 else -1
            complain(
                f"The discovery ports of messages and services are both {message_port}; "
                f"services use {service_port} instead."
            )
        return cls(
            ip=_address(environment, "GZ_IP", DEFAULT_IP),
            group=_address(environment, "GZ_DISCOVERY_MULTICAST_IP", DEFAULT_GROUP),
            message_port=message_port,
            service_port=service_port,
            send_high_water_mark=_number(environment, "GZ_TRANSPORT_SNDHWM", DEFAULT_HIGH_WATER_MARK, 0, 2**31 - 1),
            receive_high_water_mark=_number(environment, "GZ_TRANSPORT_RCVHWM", DEFAULT_HIGH_WATER_MARK, 0, 2**31 - 1),
            topic_statistics=environment.get("GZ_TRANSPORT_TOPIC_STATISTICS", "") == "1",
        )


def _number(environment: Mapping[str, str], name: str, default: int, low: int, high: int) -> int:
    text = environment.get(name, "").strip()
    if not text:
        return default
    if text.isascii() and text.isdigit() and low <= int(text[:20]) <= high:
        return int(text)
    complain(f"{name} is {text!r}, but a whole number from {low} to {high} was expected; {default} is used.")
    return default


def _address(environment: Mapping[str, str], name: str, default: str) -> str:
    text = environment.get(name, "").strip()
    if not text:
        return default
    try:
        return str(ipaddress.IPv4Address(text))
    except ValueError:
        complain(f"{name} is {text!r}, but an IPv4 address such as {default} was expected; {default} is used.")
        return default
