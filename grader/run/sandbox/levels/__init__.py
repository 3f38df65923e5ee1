"""The sandbox levels, a file each, A the firmest. All follow `grader.run.sandbox.level.Level`."""
