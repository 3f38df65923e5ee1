"""The common parts of the course's ROS programs, such as `parameter_bridge`, `create` and `robot_state_publisher`.

Contents: `program` (start, signals and exit code), `errors`, `spinner` (callbacks in a thread), `parameters` (ROS
parameters with defaults), `shared_memory` (Fast DDS settings for images), `abandoned_segments` (shared memory that
killed programs left) and `last_words` (why a program ended at its start). Importing these modules loads no ROS.
"""
