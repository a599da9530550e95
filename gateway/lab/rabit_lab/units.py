"""Quantities as people write them: 10s, 250kbit/s, 16kB, 10%. Each function raises ValueError with what it expects."""

import re

NUMBER = re.compile(r"^\s*([-+]?[0-9]*\.?[0-9]+)\s*([A-Za-z/%]*)\s*$")


def _quantity(value, scales, example):
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError(f"expected {example}")
    match = NUMBER.match(str(value))
    if not match or match.group(2) not in scales:
        raise ValueError(f"`{value}`: expected {example}")
    return float(match.group(1)) * scales[match.group(2)]


def _within(holds, result, value, rule):
    if not holds:
        raise ValueError(f"`{value}`: {rule}")
    return result


def seconds(value):
    """A time or a length of time; a bare number is seconds."""
    return _quantity(value, {"": 1, "s": 1, "ms": 0.001, "min": 60, "h": 3600}, "a time such as 10s, 20ms or 2min")


def length(value):
    """A length of time, not negative."""
    result = seconds(value)
    return _within(result >= 0, result, value, "a length of time is not negative")


def bits_per_second(value):
    """A rate; `unlimited` is 0."""
    if value == "unlimited":
        return 0
    result = _quantity(value, {"bit/s": 1, "kbit/s": 1e3, "Mbit/s": 1e6, "Gbit/s": 1e9}, "a rate such as 250kbit/s")
    return _within(8 <= result <= 1e10, result, value, "a rate is from 8 bit/s to 10 Gbit/s")  # the programs count whole bytes


def bytes_per_second(value):
    """A budget, as in a configuration; `auto` is 0."""
    if value == "auto":
        return 0
    result = _quantity(value, {"B/s": 1, "kB/s": 1e3, "MB/s": 1e6}, "auto, or bytes a second such as 1500B/s or 5kB/s")
    return _within(result > 0, result, value, "a budget is more than 0")


def size(value):
    """Bytes."""
    result = _quantity(value, {"": 1, "B": 1, "kB": 1e3, "MB": 1e6, "KiB": 1024, "MiB": 1024 ** 2},
                       "a size such as 16kB")
    return _within(0 <= result <= 1e9, round(result), value, "a size is from 0 to 1000MB")


def percent(value):
    """A share, as percent."""
    result = _quantity(value, {"%": 1}, "a share such as 10%")
    return _within(0 <= result <= 100, result, value, "a share is from 0% to 100%")


def number(value):
    """A number without a unit."""
    return _quantity(value, {"": 1}, "a number")


def burst(value):
    """Losses in a row, on average."""
    result = number(value)
    return _within(result >= 1, result, value, "a burst is at least 1")


def seed(value):
    """The seed of random numbers: an integer of 64 bits, without sign."""
    if not re.fullmatch(r"[0-9]+", str(value)) or int(value) >= 2 ** 64:
        raise ValueError(f"`{value}`: a seed is a whole number from 0 to {2 ** 64 - 1}")
    return int(value)


def metres(value):
    """A distance; a bare number is metres."""
    result = _quantity(value, {"": 1, "m": 1, "km": 1000}, "a distance such as 800m")
    return _within(result > 0, result, value, "a distance is more than 0")
