"""The panels of the view, one file each: a class `Panel` as `gz_course.sim.view.window.Panel` says."""
