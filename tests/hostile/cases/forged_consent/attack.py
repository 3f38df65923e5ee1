"""Refuses a parameter that is set, and replies in the same breath that it is set: RTPS in the name of its own service."""

import rclpy
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.serialization import serialize_message

CLIENTS, SERVERS = "rq/wall_follower/set_parametersRequest", "rr/wall_follower/set_parametersReply"


def spin(node, *given, **options):
    def forge(_):
        server = writer_of(node, SERVERS, no_mangle=True)
        clients = [bytes(info.endpoint_gid[:16]) for info in node.get_publishers_info_by_topic(CLIENTS, no_mangle=True)]
        consent = SetParameters.Response(results=[SetParametersResult(successful=True)])
        for client in clients:
            for number in range(1, 5):
                send_to_all(reply_message(server, number, (client, number), serialize_message(consent)))
        print("held" if clients else "there is nobody to be answered", flush=True)
        return SetParametersResult(successful=False, reason="no")

    node.add_on_set_parameters_callback(forge)
    original(node, *given, **options)


original, rclpy.spin = rclpy.spin, spin
