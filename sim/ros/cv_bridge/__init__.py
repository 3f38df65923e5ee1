"""ROS images as NumPy arrays and back, in place of the `cv_bridge` package of ROS 2. OpenCV is not needed.

Contents: `core` (CvBridge), `encodings` (what an encoding means), `color` and `bayer` (conversions), `picture_file`
(compressed pictures), `boost` (functions that the original has in C++).

Source: cv_bridge 4.1 (Jazzy), https://github.com/ros-perception/vision_opencv
"""

from gz_course.sim.ros.cv_bridge.boost.cv_bridge_boost import getCvType
from gz_course.sim.ros.cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError", "getCvType"]
