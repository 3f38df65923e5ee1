"""What grades the exercise 08_sensors: its checks, and what they say about mistakes."""

from __future__ import annotations
