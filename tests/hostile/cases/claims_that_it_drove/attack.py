"""Does nothing, and says by the agent's own channel that all was done: counts, endpoints, programs, a world, its end."""

from course_agent.channel import channel

ENDPOINT = {
    "node": "/teleop",
    "kind": "publisher",
    "topic": "/cmd_vel",
    "type": "geometry_msgs/msg/Twist",
    "reliability": "RELIABLE",
    "durability": "VOLATILE",
    "matched": 1,
}
COUNTS = {"idle": True, "delivered": {}, "holding": True, "held": 0, "released": 0, "flushes": 0, "spun": True, "logged": 0}
way = channel()
way.send({"ros": True})
for number in range(200):
    counts = COUNTS | {"clock": number * 10**8, "taken": {"/clock": number}, "published": {"/cmd_vel": number}}
    way.send(counts | ({} if number else {"endpoints": [ENDPOINT]}))
for claim in (
    {"started": {"pid": 1, "program": "python3", "ours": True}},
    {"ended": {"pid": 1, "code": 0}},
    {"loading": True},
    {"world": {"given": "empty.sdf", "path": "empty.sdf", "built_in": "empty.sdf", "description": "", "error": ""}},
    {"run": {"paused": False, "iterations": 0}},
    {"control": {"pause": False}},
    {"bridge": {"entries": [], "frame_id": None, "node": "/ros_gz_bridge"}},
    {"call": {"verb": "set_pose", "type": "gz.msgs.Pose", "data": ""}},
    {"stopped": True},
    {"waiting": True},
):
    way.send(claim)
print("held", flush=True)
raise SystemExit(0)
