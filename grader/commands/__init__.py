"""The sub-commands of `course`, one file each; every module in this folder is a sub-command."""
