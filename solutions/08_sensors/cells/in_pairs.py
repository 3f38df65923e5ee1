from message_filters import ApproximateTimeSynchronizer


def in_pairs(colour, depth, callback):
    pairs = ApproximateTimeSynchronizer([colour, depth], queue_size=10, slop=0.05)
    pairs.registerCallback(callback)
    return pairs
