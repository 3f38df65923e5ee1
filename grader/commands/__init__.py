"""The sub-commands of `course`: one file each, found by being in this folder."""
