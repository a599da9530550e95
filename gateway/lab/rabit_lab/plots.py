"""Pictures (SVG) of a run, with nothing but text."""

import html
import math

from rabit_lab.flight import oldest

WIDTH, LEFT, RIGHT = 1040, 130, 16
COLOURS = ("#2a78d6", "#1b9e77", "#c98500", "#d0473f", "#5b4ab0", "#c65d94", "#4d8a1f", "#c8602c")
STATES = {"UP": "#2f9e44", "STALE": "#f2a900", "LOST": "#d0342c", "": "#d5d9de"}
INK, FAINT, GRID = "#1d2733", "#6b7683", "#e6e9ed"
COLUMNS = 500  # points of a line
MOST_LINES = 8
SILENT_S = 2.5  # a node tells each second what it sends


def escape(text):
    return html.escape(str(text), quote=True)


def nice_step(span, parts):
    """A round step that cuts a span into about that many parts."""
    raw = max(span, 1e-12) / parts
    power = 10 ** math.floor(math.log10(raw))
    return next(step * power for step in (1, 2, 2.5, 5, 10) if step * power >= raw)


class Picture:
    """A plot over the time of a run, with the faults as marks."""

    def __init__(self, title, flight, height):
        self.title, self.flight, self.height = title, flight, height
        self.parts = []
        self.top, self.bottom = 34, height - 26
        self.end = max(flight.end, 1e-3)

    def x(self, time):
        return LEFT + (WIDTH - LEFT - RIGHT) * min(max(time / self.end, 0), 1)

    def rect(self, begin, end, y, height, colour, tip):
        self.parts.append(f'<rect x="{self.x(begin):.1f}" y="{y:.1f}" width="{max(self.x(end) - self.x(begin), 1):.1f}" '
                          f'height="{height:.1f}" fill="{colour}"><title>{escape(tip)}</title></rect>')

    def text(self, x, y, text, anchor="start", colour=FAINT, size=11):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" '
                          f'font-size="{size}">{escape(text)}</text>')

    def line(self, x1, y1, x2, y2, colour, more=""):
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" {more}/>')

    def frame(self):
        """Times, and the faults."""
        step = nice_step(self.end, 10)
        for n in range(int(self.end / step + 1e-6) + 1):
            self.line(self.x(n * step), self.top, self.x(n * step), self.bottom, GRID)
            self.text(self.x(n * step), self.bottom + 15, f"{n * step:g} s", "middle")
        for fault in self.flight.faults:
            last = min(fault.ended, self.end)
            if last > fault.began:
                self.parts.append(f'<rect x="{self.x(fault.began):.1f}" y="{self.top}" '
                                  f'width="{self.x(last) - self.x(fault.began):.1f}" height="{self.bottom - self.top}" '
                                  f'fill="#5b6b7b" opacity="0.09"><title>{escape(fault.text)}</title></rect>')

    def marks(self):
        """A line for each event, with its number in the list of events above, if there is room for it."""
        free = -math.inf
        for number, fault in enumerate(self.flight.events(), 1):
            x = self.x(fault.began)
            self.parts.append(f'<g><line x1="{x:.1f}" y1="{self.top - 4}" x2="{x:.1f}" y2="{self.bottom}" stroke="#5b6b7b" '
                              f'stroke-dasharray="3 3"/><title>{escape(f"{fault.began:g} s: {fault.text}")}</title></g>')
            if x >= free:
                self.text(x, self.top - 6, number, "middle", INK, 10)
                free = x + 14

    def svg(self):
        self.marks()
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {self.height}" width="{WIDTH}" '
                f'height="{self.height}" font-family="system-ui, sans-serif" role="img">'
                f'<rect width="{WIDTH}" height="{self.height}" fill="#ffffff"/>'
                f'<text x="0" y="16" fill="{INK}" font-size="14" font-weight="600">{escape(self.title)}</text>')
        return head + "".join(self.parts) + "</svg>"


def states(flight):
    """A lane for each node: the states that the others saw it in, by their shares, and when its process ran."""
    names = list(flight.scenario.nodes)
    picture = Picture("How the others saw each node", flight, 60 + 26 * len(names) + 16)
    picture.bottom -= 16
    picture.frame()
    for row, node in enumerate(names):
        y = picture.top + 26 * row + 3
        picture.text(LEFT - 8, y + 11, node, "end", INK, 12)
        for begin, end, seen in seen_states(flight, node):
            top, observers = y, sum(count for _, count in seen)
            for state, count in seen:
                height = 12 * count / observers
                picture.rect(begin, end, top, height, STATES[state],
                             f"{node} {state or 'not known'} at {count}, {begin:.1f} to {end:.1f} s")
                top += height
        for life in flight.lives_of(node):
            picture.rect(life.began, min(life.ended if life.ended is not None else flight.end, flight.end), y + 14, 4,
                         "#39424e", f"{node} runs, incarnation {life.number}")
    x = LEFT
    for state, text in (("UP", "UP"), ("STALE", "STALE"), ("LOST", "LOST"), ("", "not known")):
        picture.parts.append(f'<rect x="{x}" y="{picture.height - 13}" width="11" height="11" fill="{STATES[state]}"/>')
        picture.text(x + 16, picture.height - 4, text)
        x += 80
    picture.parts.append(f'<rect x="{x}" y="{picture.height - 9}" width="18" height="4" fill="#39424e"/>')
    picture.text(x + 24, picture.height - 4, "the process runs")
    return picture.svg()


def seen_states(flight, node):
    """[(from, to, [(state, number of the other nodes that are there and have it so)])], LOST last."""
    observers = flight.observers(node)
    times = {0.0, flight.end}
    for index, life in observers:
        times.update(time for time in flight.peers[index, node].times if 0 < time < flight.end)
        times.update(time for time in (life.began, life.ended) if time is not None and 0 < time < flight.end)
    spans = []
    ordered = sorted(times)
    for begin, end in zip(ordered, ordered[1:]):
        states_now = [peer.state for index, life in observers if life.is_there(begin)
                      for peer in [flight.peers[index, node].at(begin)] if peer]
        seen = [(state, states_now.count(state)) for state in ("UP", "STALE", "LOST") if state in states_now] or [("", 1)]
        if spans and spans[-1][2] == seen:
            spans[-1] = (spans[-1][0], end, seen)
        else:
            spans.append((begin, end, seen))
    return spans


def lines(title, flight, unit, series, among=0):
    """`series`: {name: [(time, value)]}; those with the largest values are shown, of `among` in all."""
    ranked = sorted(series.items(), key=lambda item: -max((value for _, value in item[1] if value is not None), default=0))
    shown = ranked[:MOST_LINES]
    rows = (len(shown) + 3) // 4
    picture = Picture(title, flight, 220 + 16 * rows)
    picture.bottom = 196
    picture.frame()
    top = max((value for _, points in shown for _, value in points if value is not None), default=0) or 1
    step = nice_step(top, 4)
    top = step * math.ceil(top / step - 1e-9)
    for n in range(round(top / step) + 1):
        y = picture.bottom - (picture.bottom - picture.top) * n * step / top
        picture.line(LEFT, y, WIDTH - RIGHT, y, GRID)
        picture.text(LEFT - 8, y + 4, f"{n * step:g} {unit}", "end")
    for number, (name, points) in enumerate(sorted(shown)):
        colour = COLOURS[number % len(COLOURS)]
        path, last = "", None
        for time, value in points:
            gap = last is None or value is None
            if value is not None:
                y = picture.bottom - (picture.bottom - picture.top) * value / top
                path += f"{'M' if gap else 'L'}{picture.x(time):.1f} {y:.1f}"
            last = value
        picture.parts.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.6"><title>{escape(name)}'
                             "</title></path>")
        x, y = LEFT + 225 * (number % 4), picture.height - 16 * rows + 16 * (number // 4) + 6
        picture.parts.append(f'<rect x="{x}" y="{y - 8}" width="14" height="4" fill="{colour}"/>')
        picture.text(x + 20, y - 2, name if len(name) < 32 else name[:30] + "...")
    among = max(among, len(ranked))
    if among > len(shown):
        picture.text(WIDTH - RIGHT, 16, f"the {len(shown)} largest of {among}", "end")
    return picture.svg()


def ages(flight):
    """{message: SVG}: how old what nodes knew of each other was."""
    streams = {}
    for index, origin, message in flight.values:
        observer = flight.lives[index].node
        if observer != origin:
            streams.setdefault(message, set()).add((origin, observer))
    result = {}
    for message, pairs in sorted(streams.items()):
        found = {pair: flight.ages(pair[1], pair[0], message, 0, flight.end) for pair in sorted(pairs)}
        worst = sorted(found, key=lambda pair: -(oldest(found[pair])[0] or 0))[:MOST_LINES]
        series = {}
        for origin, observer in worst:
            columns = {}
            for begin, end, age in found[origin, observer]:
                first, last = (min(int(COLUMNS * t / flight.end), COLUMNS - 1) for t in (begin, end))
                for column in range(first, last + 1):
                    until = min(end, (column + 1) * flight.end / COLUMNS)
                    columns[column] = max(columns.get(column, 0), age + until - begin)
            # A column without a value, because the observer was not there, breaks the line.
            series[f"{origin} at {observer}"] = [((column + 0.5) * flight.end / COLUMNS, columns.get(column))
                                                 for column in range(COLUMNS)]
        result[message] = lines(f"Age of {message}", flight, "s", series, len(found))
    return result


def rates(flight):
    """{message: SVG}: values that came each second."""
    counts = {}
    for (index, origin, message), values in flight.values.items():
        observer = flight.lives[index].node
        if observer == origin:
            continue
        bins = counts.setdefault(message, {}).setdefault(f"{origin} at {observer}", [0] * (int(flight.end) + 1))
        for at, _ in values:
            if 0 <= at < flight.end:
                bins[int(at)] += 1
    return {message: lines(f"Values of {message} each second", flight, "/s",
                           {name: [(n + 0.5, count) for n, count in enumerate(bins) if n + 1 <= flight.end]
                            for name, bins in series.items()})
            for message, series in sorted(counts.items())}


def sends(flight):
    """What each node sends, as it counts itself."""
    series = {}
    for node, points in flight.air.items():
        line = series.setdefault(node, [])
        for time, used, *_ in points:
            if 0 <= time <= flight.end:
                if line and time - line[-1][0] > SILENT_S:
                    line.append((line[-1][0], None))  # the line breaks while it does not run
                line.append((time, used / 1000))
    return lines("What each node sends, with all headers", flight, "kB/s", series) if series else ""


def channel(flight, name):
    """[SVG]: frames, and the share of the time in which the channel was used."""
    points = flight.radio.get(name, [])
    if not points:
        return []
    frames = {"offered": [], "on the air": [], "dropped by full queues": [], "lost on the way": []}
    used, longest = [], []
    for (begin, first), (end, last) in zip(points, points[1:]):
        span = max(end - begin, 1e-9)

        def per_second(pick, first=first, last=last, span=span):
            return sum(pick(last["nodes"][node]) - pick(first["nodes"][node]) for node in last["nodes"]) / span
        middle = (begin + end) / 2
        frames["offered"].append((middle, per_second(lambda node: node["offered"]["frames"])))
        frames["on the air"].append((middle, (last["sent"]["frames"] - first["sent"]["frames"]) / span))
        frames["dropped by full queues"].append((middle, per_second(lambda node: node["dropped"]["frames"])))
        frames["lost on the way"].append((middle, per_second(lambda node: node["lost"] + node["missed"] + node["collided"])))
        used.append((middle, 100 * (last["busy_s"] - first["busy_s"]) / span))
        longest.append((end, max((node["wait_ms"] for node in last["nodes"].values()), default=0)))
    pictures = [lines(f"Frames on {name}", flight, "/s", frames)]
    if points[-1][1]["bits_per_s"]:
        pictures.append(lines(f"Use of {name}", flight, "%", {"share of the time": used}))
        pictures.append(lines(f"Waits in the queues of {name}", flight, "ms", {"longest": longest}))
    return pictures
