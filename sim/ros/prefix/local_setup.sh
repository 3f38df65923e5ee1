# On a full install this file sets up the environment; here every Python of the environment does so (local_setup.py).
# The file exists because the setup files of a colcon workspace source that of each prefix it was built with.
