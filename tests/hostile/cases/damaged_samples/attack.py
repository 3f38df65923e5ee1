"""Sends samples that no message can be read from, in its own name, to whoever listens: the bridge, and the grader's log."""

import rclpy

DAMAGED = [b"\0\1\0\0" + rest for rest in (b"", b"\xff", b"\xff" * 7, b"\xff" * 64)] + [b"", b"\xff\xff\xff\xff"]


def spin(node, *given, **options):
    def forge():
        own = [writer_of(node, topic) for topic in ("/cmd_vel", "/rosout", "/parameter_events")]
        for writer in filter(None, own):
            for number in range(1, 200):
                send_to_all(data_message(writer, number, DAMAGED[number % len(DAMAGED)]))
        print("held" if own[0] else "there is nobody to be", flush=True)
        timer.cancel()

    timer = node.create_timer(1.0, forge)
    original(node, *given, **options)


original, rclpy.spin = rclpy.spin, spin
