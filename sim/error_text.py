"""Errors of Python in words: some have no text of their own."""

from __future__ import annotations


def named(error: BaseException) -> str:
    """Return type and text of an error on one line; one without a text has only its type, or words of ours."""
    text = " ".join(str(error).split())
    if not text and isinstance(error, MemoryError):
        text = "it needs more memory than there is"
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
