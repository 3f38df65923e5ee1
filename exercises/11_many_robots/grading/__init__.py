"""What grades the exercise 11_many_robots: its checks, and what they say about mistakes."""

from __future__ import annotations
