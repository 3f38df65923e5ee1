def depth_at(depth, row, column):
    first = row * depth.step + 4 * column
    return float(np.frombuffer(depth.data[first : first + 4], dtype=np.float32)[0])
