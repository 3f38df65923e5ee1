"""Various multicast related sub-commands."""
