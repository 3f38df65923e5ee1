"""Events of nodes; those of lifecycle nodes are in `launch_ros.events.lifecycle`."""
