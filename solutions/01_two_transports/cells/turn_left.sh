gz topic -t /model/robot/cmd_vel -m gz.msgs.Twist -p 'angular: {z: 0.5}'
