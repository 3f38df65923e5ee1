"""Topic names from the `<topic>` texts of SDF, made valid as Gazebo does it.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/Util.cc (validTopic)
"""

from __future__ import annotations


def valid_topic(*candidates: str) -> str:
    """Return the first candidate that can be made a topic name: absolute, with underscores for blanks.

    Raises ValueError if there is none.
    """
    for candidate in candidates:
        name = candidate.strip().replace(" ", "_")
        for forbidden in ("@", "~", ":=", "//"):
            name = name.replace(forbidden, "/" if forbidden == "//" else "")
        name = name.strip("/")
        if name:
            return "/" + name
    raise ValueError(f"none of {list(candidates)} can be a topic name")
