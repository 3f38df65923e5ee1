"""Accepts every goal, and replies itself that they were rejected: RTPS to the exercise's own node, in the server's name."""

from patrol_interfaces.action import Patrol as Forged
from rclpy.serialization import serialize_message

CLIENTS, SERVERS = (f"{kind}/patrol/_action/send_goal{name}" for kind, name in (("rq", "Request"), ("rr", "Reply")))


def forge(node):
    client, server = writer_of(node, CLIENTS, no_mangle=True), writer_of(node, SERVERS, no_mangle=True)
    reply = serialize_message(Forged.Impl.SendGoalService.Response(accepted=False))
    if client and server:
        for number in range(1, 5):
            send_to_all(reply_message(server, number, (client, number), reply))
    print("held" if client and server else "there is nobody to be", flush=True)


def attacked(on_goal):
    def on_goal_of_the_attack(node, goal):
        if not goal.waypoints:  # the first of four that come at once
            forge(node)
        return on_goal(node, goal)

    return on_goal_of_the_attack
