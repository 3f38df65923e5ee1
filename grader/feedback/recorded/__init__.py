"""The places in a student's file that were recorded as facts of its run, as sentences for what a check has seen."""
