"""Makes foreign text fit to be shown: no control codes, no endless lines."""

from __future__ import annotations

LONGEST = 400  # [characters] of one piece of foreign text


def shown(text: str, longest: int = LONGEST) -> str:
    """Return `text` on one line, with everything unprintable replaced and what is too long cut."""
    clean = "".join(c if c.isprintable() else " " if c in "\t\n\r" else "\N{REPLACEMENT CHARACTER}" for c in text)
    return clean if len(clean) <= longest else f"{clean[: longest - 1]}…"
