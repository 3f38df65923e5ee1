"""The folder a student works in: laid out from the installed course, and brought up to date."""
