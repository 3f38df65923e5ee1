"""Between the sides: the packages of ros_gz, which know the messages of both."""
