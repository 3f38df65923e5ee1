"""What grades the exercise 13_capstone: its checks, and what they say about mistakes."""

from __future__ import annotations
