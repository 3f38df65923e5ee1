"""What is wrong with a bag."""

from __future__ import annotations


class BagError(Exception):
    """A bag cannot be read or written; the text is one sentence for the user."""
