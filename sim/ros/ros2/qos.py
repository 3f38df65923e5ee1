"""The quality-of-service options of `ros2 topic echo` and `ros2 topic pub`."""

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

from gz_course.sim.ros.ros2.option_values import seconds, whole_number

_POLICIES = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}


def add_qos_options(parser: argparse.ArgumentParser, default: str) -> None:
    """Add an option for each policy; `default` describes the value without options."""
    qos = parser.add_argument_group("quality of service", f"default: {default}")
    presets = [profile.name.lower() for profile in QoSPresetProfiles]
    qos.add_argument("--qos-profile", choices=presets, help="Preset to start from")
    qos.add_argument("--qos-depth", type=whole_number, metavar="N", help="Queue size")
    for name, policy in _POLICIES.items():
        qos.add_argument(f"--qos-{name}", choices=policy.short_keys(), help=f"{name.capitalize()} setting")
    qos.add_argument(
        "--qos-liveliness-lease-duration-seconds", type=seconds, metavar="SECONDS", help="Liveliness lease duration"
    )


def chosen_qos(arguments: argparse.Namespace, default: QoSProfile) -> QoSProfile:
    """Return the preset of the options, or `default`, with the chosen policies."""
    qos = QoSPresetProfiles.get_from_short_key(arguments.qos_profile) if arguments.qos_profile else default
    if arguments.qos_depth is not None:
        qos.depth = arguments.qos_depth
    for name, policy in _POLICIES.items():
        if word := getattr(arguments, f"qos_{name}"):
            setattr(qos, name, policy.get_from_short_key(word))
    if arguments.qos_liveliness_lease_duration_seconds is not None:
        qos.liveliness_lease_duration = Duration(seconds=arguments.qos_liveliness_lease_duration_seconds)
    return qos
