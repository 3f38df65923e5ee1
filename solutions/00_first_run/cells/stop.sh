gz topic -t /model/robot/cmd_vel -m gz.msgs.Twist -p 'linear: {x: 0}'
