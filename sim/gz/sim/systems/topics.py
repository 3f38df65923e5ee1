"""How systems and sensors turn the `<topic>` texts of SDF into topic names.

Gazebo puts a slash in front of names without one and replaces what a topic may not contain.
"""

from __future__ import annotations


def valid_topic(*candidates: str) -> str:
    """Return the first candidate that can be made a topic name, absolute, with blanks as underscores."""
    for candidate in candidates:
        name = candidate.strip().replace(" ", "_")
        for forbidden in ("@", "~", ":=", "//"):
            name = name.replace(forbidden, "/" if forbidden == "//" else "")
        name = name.strip("/")
        if name:
            return "/" + name
    raise ValueError(f"none of {list(candidates)} can be a topic name")
