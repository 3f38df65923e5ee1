"""The public names of the packages that nodes import lead to ours, by every spelling that nodes use."""

import subprocess
import sys

PROGRAM = """
import sys, warnings
warnings.simplefilter("ignore", DeprecationWarning)
import cv_bridge, laser_geometry, message_filters
import sensor_msgs_py.point_cloud2 as pc2
from cv_bridge import CvBridge, CvBridgeError
from cv_bridge.boost.cv_bridge_boost import cvtColor2, getCvType
from cv_bridge.core import CvBridge as same
from laser_geometry.laser_geometry import LaserProjection
from message_filters import ApproximateTimeSynchronizer, Cache, Subscriber, TimeSynchronizer
from sensor_msgs_py import point_cloud2
from sensor_msgs_py.point_cloud2 import create_cloud_xyz32, read_points

assert same is CvBridge and point_cloud2 is pc2 and laser_geometry.LaserProjection is LaserProjection
assert "cv2" not in sys.modules
print(*sorted({m.__name__.split(".")[3] for m in (cv_bridge, laser_geometry, message_filters, point_cloud2)}))
"""
OURS = ["cv_bridge", "laser_geometry", "message_filters", "sensor_msgs_py"]
WITHOUT_ROS = ["nav2_common", "rosidl_runtime_py"]


def test_the_names_lead_to_ours(tmp_path):
    done = subprocess.run([sys.executable, "-c", PROGRAM], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert (done.stdout.split(), done.stderr) == (OURS, "")


def test_they_are_packages_of_the_prefix():
    from ament_index_python.packages import get_package_share_path

    for name in OURS + WITHOUT_ROS:
        assert f"<name>{name}</name>" in (get_package_share_path(name) / "package.xml").read_text()
