def turned(times, rates, standing):
    still = times <= times[0] + standing
    steps = np.diff(times, prepend=times[0])
    return float(np.sum(((rates - rates[still].mean()) * steps)[~still]))
