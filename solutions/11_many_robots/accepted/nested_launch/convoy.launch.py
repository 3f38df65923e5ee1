"""The field has a launch of its own, started as in a shell; a shell becomes each follower."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HERE = Path(__file__).parent
GAP = 1.2  # [m] from robot to robot


def create(number):
    return Node(
        package="ros_gz_sim",
        executable="create",
        arguments=[
            *("-file", str(HERE / "robot.sdf"), "-name", f"robot{number}"),
            *("-x", str(-GAP * (number - 1)), "-z", "0.01"),
        ],
    )


def follower(number):
    names = ["-r", f"__ns:=/robot{number}", "-r", f"front/odom:=/robot{number - 1}/odom"]
    parameters = ["-p", "use_sim_time:=true", "-p", f"gap:={GAP}"]
    words = " ".join(["--ros-args", *names, *parameters])
    return ExecuteProcess(cmd=["bash", "-c", f"cd '{HERE}'; exec python3 follower_node.py {words}"], output="screen")


def bridge(count):
    """One bridge for all: the clock once, and the two topics of each robot."""
    arguments, remappings = ["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"], []
    for number in range(1, count + 1):
        gazebo, ros = f"/model/robot{number}", f"/robot{number}"
        arguments.append(f"{gazebo}/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist")
        arguments.append(f"{gazebo}/odometry@nav_msgs/msg/Odometry[gz.msgs.Odometry")
        remappings += [(f"{gazebo}/cmd_vel", f"{ros}/cmd_vel"), (f"{gazebo}/odometry", f"{ros}/odom")]
    return Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=arguments, remappings=remappings)


def convoy(context):
    count = int(LaunchConfiguration("robots").perform(context))
    robots = [create(number) for number in range(1, count + 1)]
    followers = [follower(number) for number in range(2, count + 1)]
    return [bridge(count), *robots, *followers]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="2", description="Number of robots in the convoy"),
            ExecuteProcess(
                cmd=["ros2", "launch", "ros_gz_sim", "gz_sim.launch.py", f"gz_args:=-s -r {HERE / 'field.sdf'}"]
            ),
            OpaqueFunction(function=convoy),
        ]
    )
