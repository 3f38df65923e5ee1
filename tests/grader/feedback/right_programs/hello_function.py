"""A publisher made of functions and a closure."""

import rclpy
from std_msgs.msg import String


def greeting_timer(node, publisher):
    counter = 0

    def tick():
        nonlocal counter
        counter += 1
        publisher.publish(String(data=f"hello {counter}"))

    return node.create_timer(0.5, tick)


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node("hello")
    pub = node.create_publisher(String, "/hello", 10)
    timer = greeting_timer(node, pub)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        timer.cancel()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
