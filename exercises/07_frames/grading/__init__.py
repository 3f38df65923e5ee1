"""What grades the exercise 07_frames: its checks, and what they say about mistakes."""

from __future__ import annotations
