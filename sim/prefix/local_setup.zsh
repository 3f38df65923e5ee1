# Every Python of this environment does by itself what this file does on a full install (local_setup.py). It is here
# because the setup files of a colcon workspace source the one of each prefix that was there when it was built.
