"""Builds ROS packages of build type `ament_cmake` where CMake and ament_cmake are not installed.

`cmake_text.py` reads the language, `cmake_lists.py` what a CMakeLists.txt says about interfaces, Python modules and
installed files, command by command (`cmake_commands.py`). `interfaces.py` checks the interfaces,
`build.py` puts all into the install prefix. `colcon_extensions.py` makes `colcon build` use it. Nothing is compiled:
the classes of an interface are made from its text when it is imported (`sim/ros/rosidl`).
"""
