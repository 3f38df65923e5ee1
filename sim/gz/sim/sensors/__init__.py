"""The sensors: one file per sensor type, found by a scan of this folder, with the plugin that runs it if it has one."""
