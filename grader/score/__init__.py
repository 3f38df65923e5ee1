"""Score a recording: nothing in here runs anything or knows how the recording came about."""
