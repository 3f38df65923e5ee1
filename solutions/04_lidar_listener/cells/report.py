def report(valid):
    mean = sum(valid) / len(valid)
    return f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={mean:.2f}m"
