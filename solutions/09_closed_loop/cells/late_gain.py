late_gain = 0.75
