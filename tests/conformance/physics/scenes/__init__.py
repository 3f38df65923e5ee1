"""The scenes, one file for each kind; `SCENES` of a file are found by `table.kinds`."""
