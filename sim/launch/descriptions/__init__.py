"""Descriptions of what can be executed."""

from launch.descriptions.executable import Executable

__all__ = ["Executable"]
