"""The systems: what acts on a world besides physics. One file per system; `registry` finds them by scanning
this folder.
"""
