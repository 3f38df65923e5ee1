"""The functions that the original implements in C++."""
