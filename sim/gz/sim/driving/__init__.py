"""The common parts of systems that drive joints and wheels: controllers, speed limits, odometry."""
