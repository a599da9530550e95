"""Tells how busy this machine is, and waits until it is quiet: for whatever measures time."""

import os
import time

from skipped import skip

QUIET = 0.15  # of one processor


def busy_seconds():
    """Seconds that all processors together have computed since the machine started."""
    with open("/proc/stat", encoding="ascii") as stat:
        user, nice, system, _, _, irq, softirq, steal = (int(field) for field in stat.readline().split()[1:9])
    return (user + nice + system + irq + softirq + steal) / os.sysconf("SC_CLK_TCK")


def own_seconds():
    """Seconds that this process and the children that it has waited for have computed."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Load:
    """The share of one processor that everything but this process and its ended children used since the begin."""

    def __init__(self, others=lambda: busy_seconds() - own_seconds(), clock=time.monotonic):
        self._others = others
        self._clock = clock
        self._begin = clock(), others()

    def share(self):
        begin, used = self._begin
        return max(0.0, self._others() - used) / max(self._clock() - begin, 1e-9)


def wait_until_quiet(seconds=600.0, load=Load, pause=time.sleep):
    """Waits until everything else uses less than QUIET of one processor for 5 s, for at most `seconds`. Returns the share
    that was used in the last 5 s; the machine is quiet if it is below QUIET."""
    while True:
        meter = load()
        pause(5)
        seconds -= 5
        share = meter.share()
        if share < QUIET or seconds <= 0:
            return share


def refuse_noise(what, seconds=600.0):
    """Waits until the machine is quiet. Ends this test as skipped if it is not within `seconds`."""
    share = wait_until_quiet(seconds)
    if share >= QUIET:
        skip(f"{what} is measured only while other programs use less than {QUIET * 100:.0f} % of a processor; "
             f"now they use {share * 100:.0f} %")
