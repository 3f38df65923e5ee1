"""The tools of Gazebo and ROS 2, by side: `gz`, `ros`, what lies between them (`bridge`), what shows them (`show`)."""
