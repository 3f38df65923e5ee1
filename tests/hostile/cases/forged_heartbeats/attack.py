"""Says in the name of others what has been sent and what has arrived: of the grader, and of its own publishers."""

import rclpy


def spin(node, *given, **options):
    def forge():
        reader, writer, own = reader_of(node, "/cmd_vel"), writer_of(node, "/odom"), writer_of(node, "/cmd_vel")
        for number in range(1, 20):
            send_to_all(heartbeat(writer or bytes(16), 1_000 * number, number + 10_000))
            send_to_all(heartbeat(own or bytes(16), 1_000 * number, number + 10_000))
            send_to_all(acknowledgement(reader or bytes(16), own or bytes(16), 1_000 * number, number + 10_000))
        print("held" if reader and own else "held, there is nobody to be", flush=True)
        timer.cancel()

    timer = node.create_timer(1.0, forge)
    original(node, *given, **options)


original, rclpy.spin = rclpy.spin, spin
