"""Loss by distance: positions that nodes publish, or those of a CSV file."""

import bisect
import csv
import math

EARTH_RADIUS_M = 6371000.0
DEGREES = (("latitude_deg", "longitude_deg", "altitude_m"), ("latitude", "longitude", "altitude"), ("lat", "lon", "alt"),
           ("lat_deg", "lon_deg", "alt_m"))
METRES = (("x", "y", "z"), ("north_m", "east_m", "down_m"), ("x_m", "y_m", "z_m"))
EXPONENT = 20 / 3  # of free space: 6 dB for twice the distance, and 3 dB change the odds of a loss by ten


def loss_at(distance, place):
    """The share of frames that is lost at that distance, in percent."""
    if place.falloff == "sharp":
        return 100.0 if distance > place.metres else 0.0
    if distance <= 0:
        return 0.0
    return 100.0 / (1.0 + (place.metres / distance) ** EXPONENT)


def find_fields(value, wanted):
    """Names of the three members of a position in a message, or none."""
    for names in ([tuple(wanted)] if wanted else DEGREES + METRES):
        if isinstance(value, dict) and all(isinstance(value.get(name), (int, float)) for name in names):
            return names
    return None


def is_geographic(names):
    return names is not None and names[0].startswith("lat")


def metres_of(position, origin):
    """A geographic position in metres around an origin."""
    north = math.radians(position[0] - origin[0]) * EARTH_RADIUS_M
    east = math.radians(position[1] - origin[1]) * EARTH_RADIUS_M * math.cos(math.radians(origin[0]))
    return (north, east, position[2] - origin[2])


class Track:
    """Positions of a CSV file with the columns time_s, node, x, y, z (metres), or latitude_deg, longitude_deg, altitude_m. They
    are connected by straight lines. ValueError if the file has none."""

    def __init__(self, path):
        self._rows = {}
        self.names = None
        with open(path, newline="", encoding="utf-8") as file:
            for number, row in enumerate(csv.DictReader(file), start=2):
                try:
                    values = {key.strip(): text for key, text in row.items() if key}
                    position = {key: float(text) for key, text in values.items() if key not in ("node", "time_s")}
                    self.names = find_fields(position, [])
                    self._rows.setdefault(values["node"].strip(), []).append(
                        (float(values["time_s"]), tuple(position[name] for name in self.names)))
                except (KeyError, TypeError, ValueError, AttributeError) as error:
                    raise ValueError(f"{path}:{number}: expected time_s, node, x, y, z") from error
        for rows in self._rows.values():
            rows.sort()

    def at(self, time):
        """{node: position}"""
        return {node: self._between(rows, time) for node, rows in self._rows.items()}

    @staticmethod
    def _between(rows, time):
        after = bisect.bisect_right(rows, time, key=lambda row: row[0])
        if after in (0, len(rows)):
            return rows[min(after, len(rows) - 1)][1]
        (begin, first), (end, second) = rows[after - 1], rows[after]
        share = (time - begin) / (end - begin) if end > begin else 0
        return tuple(a + share * (b - a) for a, b in zip(first, second))


class Places:
    """Where the nodes of one network are, and what that makes of its loss."""

    def __init__(self, network, folder):
        self._range = network.range
        self._network = network
        self._track = Track(folder / self._range.source) if self._range.source.endswith(".csv") else None
        self._known = {}  # node -> position as told
        self._names = self._track.names if self._track else None
        self._told = {}  # (from, to) -> percent
        self.refused = set()  # nodes whose message holds no position

    @property
    def message(self):
        """The message that it takes positions from, or none."""
        return None if self._track else self._range.source

    def take(self, node, value):
        names = find_fields(value, self._range.fields)
        if names is None:
            self.refused.add(node)
            return
        self._names = self._names or names
        self._known[node] = tuple(float(value[name]) for name in names)

    def positions(self, time):
        """{node: (x, y, z) in metres}"""
        raw = {**self._range.places, **self._known, **(self._track.at(time) if self._track else {})}
        raw = {node: position for node, position in raw.items() if node in self._network.members}
        if not raw or not is_geographic(self._names):
            return raw
        origin = raw[min(raw)]
        return {node: metres_of(position, origin) for node, position in raw.items()}

    def changes(self, time, least=1.0):
        """[(from, to, percent, burst)] of the links whose loss has changed by a percent or more since the last call."""
        positions = self.positions(time)
        found = []
        for one, first in positions.items():
            for other, second in positions.items():
                if one == other:
                    continue
                loss, burst = self._network.loss_of(one, other)
                far = loss_at(math.dist(first, second), self._range)
                percent = 100 * (1 - (1 - loss / 100) * (1 - far / 100))
                if abs(percent - self._told.get((one, other), loss)) >= least:
                    self._told[one, other] = percent
                    found.append((one, other, percent, burst))
        return found

    def loss(self, one, other, usual):
        """The percent that `changes` gave last, or the usual one."""
        return self._told.get((one, other), usual)

    def high(self, least=50.0):
        """[(from, to, percent)] of the links that lose half or more by distance."""
        return [(one, other, percent) for (one, other), percent in self._told.items() if percent >= least]
