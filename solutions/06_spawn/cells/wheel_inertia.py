def wheel_inertia(mass, radius, length):
    across = mass * (3 * radius**2 + length**2) / 12
    return across, across, mass * radius**2 / 2
