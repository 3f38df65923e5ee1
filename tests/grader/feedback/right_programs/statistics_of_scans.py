"""Mean, count and minimum of each scan in one pass, published on topics of a table."""

import statistics
from collections.abc import Callable, Sequence

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64

STATISTICS: dict[str, Callable[[Sequence[float]], float]] = {
    "mean": statistics.fmean,
    "valid_count": lambda values: float(len(values)),
    "minimum": min,
}


class Statistics(Node):
    def __init__(self) -> None:
        super().__init__("scan_statistics")
        self.outputs = {name: self.create_publisher(Float64, f"/scan/{name}", 10) for name in STATISTICS}
        self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        values = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        if not values:
            return
        for name, function in STATISTICS.items():
            self.outputs[name].publish(Float64(data=float(function(values))))


def main() -> None:
    rclpy.init()
    rclpy.spin(Statistics())


if __name__ == "__main__":
    main()
