"""The panels of the view, one file each: a class `Panel` as `gz_course.sim.gz.view.window.Panel` says."""
