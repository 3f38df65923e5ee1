"""The quality-of-service options of `ros2 topic echo` and `ros2 topic pub`, and what follows from them."""

from __future__ import annotations

import argparse

from rclpy.duration import Duration
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)

from gz_course.sim.ros2.option_values import seconds, whole_number


def add_qos_options(parser: argparse.ArgumentParser, default: str) -> None:
    """Add an option for each policy; `default` describes what holds without them."""
    qos = parser.add_argument_group("quality of service", f"default: {default}")
    presets = [profile.name.lower() for profile in QoSPresetProfiles]
    qos.add_argument("--qos-profile", choices=presets, help="Preset to start from")
    qos.add_argument("--qos-depth", type=whole_number, metavar="N", help="Queue size")
    qos.add_argument("--qos-history", choices=HistoryPolicy.short_keys(), help="History setting")
    qos.add_argument("--qos-reliability", choices=ReliabilityPolicy.short_keys(), help="Reliability setting")
    qos.add_argument("--qos-durability", choices=DurabilityPolicy.short_keys(), help="Durability setting")
    qos.add_argument("--qos-liveliness", choices=LivelinessPolicy.short_keys(), help="Liveliness setting")
    qos.add_argument(
        "--qos-liveliness-lease-duration-seconds", type=seconds, metavar="SECONDS", help="Liveliness lease duration"
    )


def chosen_qos(arguments: argparse.Namespace, default: QoSProfile) -> QoSProfile:
    """Return the preset of the options, or else `default`, with the chosen policies."""
    qos = QoSPresetProfiles.get_from_short_key(arguments.qos_profile) if arguments.qos_profile else default
    if arguments.qos_depth is not None:
        qos.depth = arguments.qos_depth
    if arguments.qos_history:
        qos.history = HistoryPolicy.get_from_short_key(arguments.qos_history)
    if arguments.qos_reliability:
        qos.reliability = ReliabilityPolicy.get_from_short_key(arguments.qos_reliability)
    if arguments.qos_durability:
        qos.durability = DurabilityPolicy.get_from_short_key(arguments.qos_durability)
    if arguments.qos_liveliness:
        qos.liveliness = LivelinessPolicy.get_from_short_key(arguments.qos_liveliness)
    if arguments.qos_liveliness_lease_duration_seconds is not None:
        qos.liveliness_lease_duration = Duration(seconds=arguments.qos_liveliness_lease_duration_seconds)
    return qos
