"""What to do about packages that nodes and launch files import, and that are not installed.

Source: the packages of the ROS 2 Jazzy distribution, https://github.com/ros/rosdistro (jazzy/distribution.yaml)
"""

from __future__ import annotations

_CHAPTERS = "pip install 'gz-ros2-course[chapters]' installs it"
_PIP = "pip install {0} installs it; on a full installation: sudo apt install ros-jazzy-{1}"
_MESSAGES = (
    "clone it into a workspace, colcon build, source install/setup.bash; on a full installation: "
    "sudo apt install ros-jazzy-{0}"
)
_FULL = "it is not in this course; on a full installation: sudo apt install ros-jazzy-{0}"
_NAV2 = "it commands the servers of Nav2, which are not in this course; on a full installation: sudo apt install {0}"
_MOVEIT = "MoveIt is not in this course; on a full installation: sudo apt install ros-jazzy-moveit"
_QT = "rqt and its windows are not in this course, where `course watch` plots and shows pictures"
_ROS_1 = "that belongs to ROS 1; in ROS 2 a node imports rclpy, and a launch file launch"
_CONTROL = "ros2_control is not in this course, where plugins of the world, such as DiffDrive, drive the joints"
_COMMANDS = "the commands of ros2 have no Python interface in this course; run them with subprocess, or use rclpy"
_FIRMWARE = "its messages come with {0}: clone that package into a workspace, colcon build, source install/setup.bash"

# Name -> what to do; {0} is the name as in Debian's packages.
_ADVICE = {
    "cv2": _CHAPTERS,
    "scipy": _CHAPTERS,
    "nav2_simple_commander": _NAV2.format("ros-jazzy-nav2-simple-commander"),
    "nav2_bringup": _NAV2.format("ros-jazzy-nav2-bringup"),
    "gazebo_ros": "that belongs to Gazebo Classic, which Jazzy does not have; ros_gz_sim has taken its place",
    "px4_msgs": _FIRMWARE.format("PX4"),
    "py_trees": _PIP.format("py-trees", "py-trees"),
    "urdf_parser_py": _PIP.format("urdf-parser-py", "urdfdom-py"),
    "ros2_numpy": "Jazzy has no package of it; sensor_msgs_py.point_cloud2 and cv_bridge make arrays of messages",
    "image_transport_py": "Jazzy does not have it; subscribe with rclpy, and cv_bridge makes arrays of the pictures",
    **dict.fromkeys(("moveit", "moveit_configs_utils", "launch_param_builder"), _MOVEIT),
    **dict.fromkeys(("rqt_gui", "rqt_gui_py", "rqt_py_common", "qt_gui", "python_qt_binding"), _QT),
    **dict.fromkeys(("rospy", "roslib", "roslaunch", "rospkg", "actionlib", "dynamic_reconfigure", "tf"), _ROS_1),
    **dict.fromkeys(("controller_manager", "ros2_control"), _CONTROL),
    **dict.fromkeys(
        ("ros2cli", "ros2node", "ros2topic", "ros2param", "ros2pkg", "ros2run", "ros2launch", "ros2bag"), _COMMANDS
    ),
    **dict.fromkeys(
        (
            *("PyKDL", "angles", "camera_calibration", "diagnostic_updater", "image_geometry", "joint_state_publisher"),
            *("py_trees_ros", "rclpy_message_converter", "robot_localization", "slam_toolbox", "smach", "tf2_kdl"),
            *("tf2_sensor_msgs", "topic_tools", "yasmin"),
        ),
        _FULL,
    ),
    **dict.fromkeys(
        (
            *("apriltag_msgs", "can_msgs", "controller_manager_msgs", "gazebo_msgs", "geographic_msgs"),
            *("grid_map_msgs", "irobot_create_msgs", "map_msgs", "mavros_msgs", "moveit_msgs", "nav_2d_msgs"),
            *("octomap_msgs", "pcl_msgs", "turtlebot3_msgs", "ur_msgs", "velodyne_msgs"),
        ),
        _MESSAGES,
    ),
}
_DEBIAN = {"PyKDL": "python-orocos-kdl-vendor"}
_OWN = "no built package of that name is found: colcon build its workspace, then source install/setup.bash"
_ENDS = ("_msgs", "_msg", "_interfaces", "_interface", "_srvs", "_actions")


def advice(name: str) -> str:
    """Return what to do about a package that cannot be imported; empty if nothing is known of it."""
    if name in _ADVICE:
        return _ADVICE[name].format(_DEBIAN.get(name, name.replace("_", "-")))
    return _OWN if name.endswith(_ENDS) else ""
