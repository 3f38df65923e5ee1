from std_msgs.msg import String

greeting = String(data="good night")
