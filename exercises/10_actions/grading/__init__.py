"""What grades the exercise 10_actions: its checks, and what they say about mistakes."""

from __future__ import annotations
