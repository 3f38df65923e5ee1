def red_columns(colours):
    red = red_pixels(colours.astype(int)).any(axis=0)
    edges = np.flatnonzero(np.diff(red, prepend=False, append=False)).reshape(-1, 2)
    return [(first + after - 1) / 2 for first, after in edges]
