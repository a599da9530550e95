"""Whether a ratio has got worse than a written one."""

import math
import statistics

GOOD, WORSE, UNDECIDED, UNKNOWN = "good", "worse", "undecided: too noisy", "nothing written"
# How many times the written ratio counts as worse.
LIMIT = 1.15
CONFIDENCE = 0.98
# The bounds of the median are at most this many times apart in what is written.
CLOSE = 1.4


def median_within(ratios):
    """The bounds between which the true median lies with CONFIDENCE at least, and the measured one between them. They
    are two of the sorted ratios and hold for noise of any kind (sign test)."""
    ordered = sorted(ratios)
    count = len(ordered)
    # The largest number of ratios to leave out at each end.
    left_out, tail = 0, 0.5 ** count
    while left_out < (count - 1) // 2 and tail + math.comb(count, left_out + 1) * 0.5 ** count <= (1 - CONFIDENCE) / 2:
        left_out += 1
        tail += math.comb(count, left_out) * 0.5 ** count
    return ordered[left_out], statistics.median(ordered), ordered[-1 - left_out]


def is_close(ratios):
    """True if the median is known closely enough to be written."""
    low, _, high = median_within(ratios)
    return high <= CLOSE * low


def verdict(written, ratios):
    """GOOD if the median is within the limit; WORSE if it is beyond it and certainly above what is written; else
    UNDECIDED. UNKNOWN if nothing is written."""
    if written is None:
        return UNKNOWN
    low, middle, _ = median_within(ratios)
    if middle <= LIMIT * written:
        return GOOD
    return WORSE if low > written else UNDECIDED
