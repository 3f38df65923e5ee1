"""What grades the exercise 12_debugging: its checks, and what they say about mistakes."""

from __future__ import annotations
