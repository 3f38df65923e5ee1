"""Foreign text made fit to be shown: no control codes, no endless lines."""

from __future__ import annotations

import math
import re
from typing import Any

LONGEST = 400  # [characters] of one piece of foreign text

# Characters that XML 1.0 cannot hold even escaped, or that HTML forbids; terminals may interpret some of them. Source:
# W3C, "Extensible Markup Language (XML) 1.0", section 2.2.
NOT_STORABLE = re.compile("[^\t\n\r -~\xa0-\ud7ff\ue000-\ufdcf\ufdf0-\ufffd\U00010000-\U0010ffff]")


def shown(text: str, longest: int = LONGEST) -> str:
    """Return `text` on one line, cut to `longest` characters, with everything unprintable replaced."""
    clean = text
    if not text.isprintable():
        clean = "".join(c if c.isprintable() else " " if c in "\t\n\r" else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= longest else f"{clean[: longest - 1]}…"


def storable(value: Any) -> Any:
    """Return plain data that every program can read.

    Control codes and lone surrogates are replaced; infinities and NaN become None.
    """
    if isinstance(value, str):
        return NOT_STORABLE.sub("\N{REPLACEMENT CHARACTER}", value)
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {storable(key): storable(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [storable(each) for each in value]
    return value
