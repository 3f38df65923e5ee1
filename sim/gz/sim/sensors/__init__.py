"""The sensor types: one file for each, found by a scan of this folder, with the plugin that runs it if it has its
own.
"""
