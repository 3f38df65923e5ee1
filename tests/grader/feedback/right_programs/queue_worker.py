"""A worker thread behind a queue."""

import queue
import threading

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64


class Worker(Node):
    def __init__(self):
        super().__init__("queue_worker")
        self.waiting = queue.Queue(maxsize=10)
        self.out = self.create_publisher(Float64, "result", 10)
        self.create_subscription(LaserScan, "/scan", self.put, 10)
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def put(self, scan):
        try:
            self.waiting.put_nowait(scan)
        except queue.Full:
            self.get_logger().warning("too slow", throttle_duration_sec=1.0)

    def run(self):
        while True:
            scan = self.waiting.get()
            valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
            if valid:
                self.out.publish(Float64(data=max(valid)))


def main():
    rclpy.init()
    rclpy.spin(Worker())


if __name__ == "__main__":
    main()
