"""What the worlds of gz-sim 8 do here, as a table, and the program that tries them: `make worlds DIR=FOLDER`."""
