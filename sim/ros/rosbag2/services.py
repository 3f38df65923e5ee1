"""The services of recorder and player, such as `/rosbag2_player/toggle_paused`.

Source: rosbag2_transport 0.26 (`player.cpp`, `recorder.cpp`): names; rosbag2_interfaces 0.26: types
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.rosbag2.playing.player import Player
from gz_course.sim.ros.rosbag2.recording.recorder import Recorder

Answer = Callable[[Any], dict[str, Any] | None]


def offer_player(node: Any, player: Player) -> None:
    """Offer the services of a player."""

    def seek(request: Any) -> dict[str, Any]:
        return {"success": player.seek(request.time.sec * 10**9 + request.time.nanosec)}

    _offer(
        node,
        {
            ("pause", "Pause"): lambda request: player.set_paused(True),
            ("resume", "Resume"): lambda request: player.set_paused(False),
            ("toggle_paused", "TogglePaused"): lambda request: player.toggle(),
            ("is_paused", "IsPaused"): lambda request: {"paused": player.paused},
            ("get_rate", "GetRate"): lambda request: {"rate": player.rate},
            ("set_rate", "SetRate"): lambda request: {"success": player.set_rate(request.rate)},
            ("play", "Play"): lambda request: {"success": player.play_again()},
            ("play_next", "PlayNext"): lambda request: {"success": player.play_next() == 1},
            ("burst", "Burst"): lambda request: {"actually_burst": player.play_next(request.num_messages)},
            ("seek", "Seek"): seek,
            ("stop", "Stop"): lambda request: player.stop(),
        },
    )


def offer_recorder(node: Any, recorder: Recorder) -> None:
    """Offer the services of a recorder, and tell in `events/write_split` when a new file begins."""
    services: dict[tuple[str, str], Answer] = {
        ("pause", "Pause"): lambda request: recorder.pause(),
        ("resume", "Resume"): lambda request: recorder.resume(),
        ("toggle_paused", "TogglePaused"): lambda request: recorder.toggle(),
        ("is_paused", "IsPaused"): lambda request: {"paused": recorder.paused},
        ("split_bagfile", "SplitBagfile"): lambda request: recorder.split(),
    }
    if recorder.can_snapshot:
        services["snapshot", "Snapshot"] = lambda request: {"success": recorder.snapshot()}
    _offer(node, services)
    event = importlib.import_module("rosbag2_interfaces.msg").WriteSplitEvent
    publisher = node.create_publisher(event, "events/write_split", 1)
    recorder.on_split(lambda ended, new: publisher.publish(event(closed_file=ended, opened_file=new)))


def _offer(node: Any, services: dict[tuple[str, str], Answer]) -> None:
    types = importlib.import_module("rosbag2_interfaces.srv")
    for (name, type_name), answer in services.items():

        def respond(request: Any, response: Any, answer: Answer = answer) -> Any:
            for key, value in (answer(request) or {}).items():
                setattr(response, key, value)
            return response

        node.create_service(getattr(types, type_name), f"~/{name}", respond)
