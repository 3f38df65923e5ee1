"""All frames of a `BufferCore` as YAML, as lines and as a graph for Graphviz, and the errors of a transform.

Source: tf2/src/buffer_core.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from gz_course.sim.ros.tf2_py.rotation import Pose
from gz_course.sim.ros.tf2_py.time_cache import Cache, seconds

Frames = Mapping[str, Cache | None]

_NO_PARENT = "NO_PARENT"
_SHORTEST = 100_000  # [ns] the time over which a rate is counted at least
_LEGEND = 'edge [style=invis];\n subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";\n'


def errors(parent: str, child: str, pose: Pose, authority: str) -> list[str]:
    """Return what is wrong with a transform, one sentence each."""
    found = []
    if child == parent:
        found.append(
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id and  child_frame_id '
            f'"{child}" because they are the same'
        )
    if not child:
        found.append(
            f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because child_frame_id not set '
        )
    if not parent:
        found.append(
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority "{authority}" '
            "because frame_id not set"
        )
    if any(math.isnan(number) for number in pose):
        place, turn = (" ".join(f"{number:f}" for number in part) for part in (pose[:3], pose[3:]))
        found.append(
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority "{authority}" '
            f"because of a nan value in the transform ({place}) ({turn})"
        )
        if any(math.isnan(number) for number in pose[3:]):
            found.append(
                f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from authority '
                f'"{authority}" because of an invalid quaternion in the transform ({turn})'
            )
    return found


def as_string(frames: Frames) -> str:
    """Return a line for each frame that has, or has had, a parent."""
    return "".join(
        f"Frame {frame} exists with parent {cache.parent(0) or _NO_PARENT}.\n"
        for frame, cache in frames.items()
        if cache is not None
    )


def as_yaml(frames: Frames, authorities: Mapping[str, str]) -> str:
    """Return parent, broadcaster, rate and times [s] of each frame."""
    text = "" if frames else "[]"
    for frame, cache, parent in _known(frames):
        newest, oldest = cache.latest()[0], cache.oldest()
        text += (
            f"{frame}: \n  parent: '{parent}'\n  broadcaster: '{_authority(frame, authorities)}'\n"
            f"  rate: {_rate(cache):.3f}\n  most_recent_transform: {seconds(newest)}\n"
            f"  oldest_transform: {seconds(oldest)}\n  buffer_length: {(newest - oldest) * 1e-9:.3f}\n"
        )
    return text


def as_dot(frames: Frames, authorities: Mapping[str, str], time: int = 0) -> str:
    """Return the graph of all frames; with a time [ns], how old the latest transforms are."""
    text = "digraph G {\n" if frames else 'digraph G {\n"no tf data recieved"'
    for frame, cache, parent in _known(frames):
        newest = cache.latest()[0]
        age = f"( {(time - newest) * 1e-9:.3f} sec old)" if time else ""
        text += (
            f'"{parent}" -> "{frame}"[label="Broadcaster: {_authority(frame, authorities)}\\n'
            f"Average rate: {_rate(cache):.3f} Hz\\nMost recent transform: {seconds(newest)} {age}\\n"
            f'Buffer length: {(newest - cache.oldest()) * 1e-9:.3f} sec\\n"];\n'
        )
    recorded = f'"Recorded at time: {seconds(time)}"[ shape=plaintext ] ;\n ' if time else ""
    for frame, above in frames.items():
        if (above is None and time) or (above is not None and not above.parent(0)):
            text += f'{_LEGEND}{recorded}}}->"{frame}";\n'
    return text + "}"


def _known(frames: Frames) -> Iterator[tuple[str, Cache, str]]:
    for frame, cache in frames.items():
        if cache is not None and (parent := cache.parent(0)):
            yield frame, cache, parent


def _authority(frame: str, authorities: Mapping[str, str]) -> str:
    return authorities.get(frame, "no recorded authority")


def _rate(cache: Cache) -> float:
    return len(cache) * 1e9 / max(cache.latest()[0] - cache.oldest(), _SHORTEST)
