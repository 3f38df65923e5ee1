# Starts one more process with rclpy every five seconds; none ever has a node.
import subprocess
import sys
import threading
import time


def start():
    while True:
        subprocess.Popen([sys.executable, "-c", "import rclpy, time; time.sleep(1000)"])
        time.sleep(5.0)


threading.Thread(target=start, daemon=True).start()
