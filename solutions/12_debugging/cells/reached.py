reached = stations[3]
print(reached)
