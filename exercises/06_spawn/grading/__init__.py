"""What grades the exercise 06_spawn: its checks, and what they say about mistakes."""

from __future__ import annotations
