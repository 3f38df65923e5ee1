"""The systems: what acts on a world besides physics. One file per system, found by a scan of this folder."""
