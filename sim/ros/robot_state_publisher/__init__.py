"""A publisher of a robot's description and transforms, in place of the `robot_state_publisher` package.

Contents: `kinematics` (transforms from a URDF and joint positions), `publisher` (topics and parameters) and the program
`robot_state_publisher`.

Source: README.md of https://github.com/ros/robot_state_publisher
"""
