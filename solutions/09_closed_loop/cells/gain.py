gain = 6
