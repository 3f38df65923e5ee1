"""How firmly a submission can be locked in: a file a level, A the firmest. All follow `grader.run.sandbox.level`."""
