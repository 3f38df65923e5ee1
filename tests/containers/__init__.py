"""The course where students are: files for containers, codespaces and Binder, and a minimal Debian to run them in."""
