"""What RViz is for on a full installation, drawn by Rerun: the live ROS side in a window or a browser.

`viewer.py` is Rerun's viewer as a process of ours; `drawing/` knows how each message type is drawn, one file a type;
`subscriber.py` subscribes to topics as they come; `rviz2.py` is the program.
"""
