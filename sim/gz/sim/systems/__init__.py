"""The systems: plugins that act on a world besides physics; one file for each, found by a scan of this folder."""
