print('not the rclpy you want')
