def seconds_since(start, now):
    return (now - start).nanoseconds / 1e9
