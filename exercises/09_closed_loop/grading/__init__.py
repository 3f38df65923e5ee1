"""What grades the exercise 09_closed_loop: its checks, and what they say about mistakes."""

from __future__ import annotations
