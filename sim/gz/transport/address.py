"""Checks addresses of other processes: only numeric ones are used, and from 127.0.0.1 only those of this machine.

Every address received in a datagram or a request is checked here before a socket connects to it. A process on 127.0.0.1
therefore sends nothing to other machines, and no host name has to be resolved.
"""

from __future__ import annotations

import functools
import re
import socket

_NUMERIC = re.compile(r"tcp://(\d{1,3}(?:\.\d{1,3}){3}):(\d{1,5})", re.ASCII)


def is_loopback(ip: str) -> bool:
    """Return whether an IPv4 address is in 127.0.0.0/8."""
    return ip.startswith("127.")


@functools.lru_cache(maxsize=1024)
def is_of_this_machine(ip: str) -> bool:
    """Return whether an IPv4 address belongs to this machine."""
    if is_loopback(ip):
        return True
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind((ip, 0))
        except OSError:
            return False
    return ip != "0.0.0.0"


def within_reach(ip: str, own_ip: str) -> bool:
    """Return whether a process at `own_ip` may communicate with one at `ip`: from 127.0.0.1 only within this
    machine.
    """
    return not is_loopback(own_ip) or is_of_this_machine(ip)


def is_usable(address: str, own_ip: str) -> bool:
    """Return whether an address such as `tcp://127.0.0.1:37011` may be connected to."""
    found = _NUMERIC.fullmatch(address)
    if found is None or not 0 < int(found.group(2)) < 65536:
        return False
    try:
        socket.inet_aton(found.group(1))
    except OSError:
        return False
    return within_reach(found.group(1), own_ip)
