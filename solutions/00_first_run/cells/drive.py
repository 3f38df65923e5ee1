command = Twist()
command.linear.x = 0.3
wheels.publish(command)
