"""One HTML file that shows a run, and the pictures in it as files of their own."""

import datetime
import html

from rabit_lab import plots, timeline

MOST_LINES = 5000
RUN_FILES = [
    ("scenario.yaml", "what was flown"),
    ("flight.mcap", "what every node recorded, on one time line; Foxglove and `rabit knew` open it"),
    ("records/", "the recordings of each incarnation of each node"), ("observer/", "what one observer on the air heard"),
    ("log.txt", "the log above"), ("logs/", "the output of each node"), ("radio.json", "the channels' counters"),
    ("plots/", "the pictures above"), ("junit.xml", "the verdicts, for continuous integration")]

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2733; background: #f4f6f8; margin: 0; }
main { max-width: 1080px; margin: 0 auto; padding: 24px 20px 60px; }
header { border-left: 8px solid; padding: 10px 18px; background: #fff; border-radius: 4px; }
header.good { border-color: #2f9e44; } header.bad { border-color: #d0342c; }
h1 { font-size: 24px; margin: 0; } h2 { font-size: 18px; margin: 32px 0 10px; }
p { margin: 4px 0; } .faint { color: #5f6b78; }
section { background: #fff; border-radius: 4px; padding: 12px 18px; margin: 10px 0; overflow-x: auto; }
table { border-collapse: collapse; width: 100%; } th { text-align: left; color: #5f6b78; font-weight: 500; }
td, th { padding: 4px 12px 4px 0; vertical-align: top; border-bottom: 1px solid #e6e9ed; }
.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.narrow { width: auto; } .figures td, .figures th { white-space: nowrap; }
.mark { font-weight: 700; white-space: nowrap; } .good .mark { color: #2f7d3b; } .bad .mark { color: #c22a22; }
tr.bad td { background: #fdf1f0; }
pre { margin: 0; font: 13px/1.45 ui-monospace, monospace; white-space: pre-wrap; }
svg { max-width: 100%; height: auto; display: block; margin: 6px 0 14px; }
#log td { font: 13px/1.4 ui-monospace, monospace; padding: 1px 10px 1px 0; border: 0; white-space: pre-wrap; }
#log tr[data-kind=lab] { background: #eef2f7; font-weight: 600; } #log tr[data-kind=problem] { color: #a3281f; }
input, select { font: inherit; padding: 3px 8px; margin: 0 8px 8px 0; }
@media (max-width: 800px) {
  main { padding: 10px 8px 40px; } section { padding: 10px; } svg { width: 800px; max-width: none; }
  #log td:last-child { overflow-wrap: anywhere; }
}
"""

SCRIPT = """
const word = document.getElementById('word'), node = document.getElementById('node'), kind = document.getElementById('kind');
function filter() {
  for (const row of document.querySelectorAll('#log tr')) {
    row.hidden = (node.value && row.dataset.node !== node.value) || (kind.value && row.dataset.kind !== kind.value) ||
      !row.textContent.toLowerCase().includes(word.value.toLowerCase());
  }
}
for (const one of [word, node, kind]) one.addEventListener('input', filter);
"""


def escape(text):
    return html.escape(str(text), quote=True)


def pictures(scenario, flight):
    """[(file name, SVG)]"""
    found = [("states", plots.states(flight))]
    found += [(f"age_{name}", svg) for name, svg in plots.ages(flight).items()]
    found += [(f"rate_{name}", svg) for name, svg in plots.rates(flight).items()]
    found += [("sends", plots.sends(flight))]
    for name in scenario.networks:
        found += [(f"{name}_{number + 1}", svg) for number, svg in enumerate(plots.channel(flight, name))]
    return [(name.replace("/", "_"), svg) for name, svg in found if svg]


def verdict_rows(scenario, verdicts):
    rows = ""
    for verdict in verdicts:
        where = f' <span class="faint">{escape(scenario.path.name)}:{verdict.line}</span>' if verdict.line else ""
        rows += (f'<tr class="{"good" if verdict.good else "bad"}"><td class="mark">{"✓ met" if verdict.good else "✗ not met"}'
                 f'</td><td>{escape(verdict.text)}{where}</td><td>{escape(verdict.detail)}</td></tr>')
    return f"<table><tr><th></th><th>expected</th><th>seen</th></tr>{rows}</table>"


def event_rows(flight):
    rows = "".join(f'<tr><td class="number faint">{number}</td><td class="number">{fault.began:g} s</td><td>{escape(fault.text)}</td></tr>'
                   for number, fault in enumerate(flight.events(), 1))
    return f'<table class="narrow">{rows}</table>' if rows else "<p>none</p>"


def census(scenario, flight):
    """What each node had on each channel."""
    text = ""
    for name in scenario.networks:
        if not flight.radio.get(name):
            continue
        counters = flight.radio[name][-1][1]
        rows = ""
        for node, count in counters["nodes"].items():
            kinds = (flight.census.get(name) or {}).get(node, {})
            most = ", ".join(f"{kind} {numbers[1] / 1000:.1f} kB" for kind, numbers in
                             sorted(kinds.items(), key=lambda item: -item[1][1])[:4])
            sent = count["multicast"]["frames"] + count["unicast"]["frames"]
            cells = (count["offered"]["frames"], count["dropped"]["frames"], sent, count["heard"]["frames"], count["lost"],
                     count["missed"], count["collided"], f"{count['longest_wait_ms']:.0f} ms")
            rows += (f"<tr><td>{escape(node)}</td>" + "".join(f'<td class="number">{cell}</td>' for cell in cells)
                     + f"<td>{escape(most)}</td></tr>")
        heads = ("node", "offered", "dropped", "sent", "heard", "lost", "cut off", "collided", "longest wait", "most of it")
        text += (f"<h3>{escape(name)}</h3><p class=faint>frames; used {100 * counters['utilisation']:.1f} % of the time</p>"
                 f"<table><tr>{''.join(f'<th>{head}</th>' for head in heads)}</tr>{rows}</table>")
    return text


def log_section(flight):
    entries = timeline.entries(flight)
    rows = "".join(f'<tr data-node="{escape(node)}" data-kind="{kind}"><td class="number">{time:.3f}</td><td>{escape(node)}</td>'
                   f"<td>{kind}</td><td>{escape(text)}</td></tr>" for time, node, kind, text in entries[:MOST_LINES])
    more = f"<p>{len(entries) - MOST_LINES} more are in log.txt</p>" if len(entries) > MOST_LINES else ""
    nodes = "".join(f"<option>{escape(node)}</option>" for node in sorted({entry[1] for entry in entries}))
    kinds = "".join(f"<option>{kind}</option>" for kind in ("lab", "state", "problem", "log", "output"))
    return (f'<input id="word" placeholder="word"><select id="node"><option value="">all nodes</option>{nodes}</select>'
            f'<select id="kind"><option value="">all</option>{kinds}</select><table id="log">{rows}</table>{more}')


def save_pictures(scenario, flight, folder):
    """Writes them as files, and returns them all as one text for a page."""
    plots_folder = folder / "plots"
    plots_folder.mkdir(exist_ok=True)
    shown = ""
    for name, svg in pictures(scenario, flight):
        (plots_folder / f"{name}.svg").write_text(svg, encoding="utf-8")
        shown += svg
    return shown


def file_rows(folder, files):
    """A table of those files that are there."""
    rows = "".join(f"<tr><td>{name}</td><td>{text}</td></tr>" for name, text in files if (folder / name).exists())
    return f"<table>{rows}</table>"


def write_page(path, title, good, summary, sections):
    """`sections`: [(heading, HTML)]; one of them has the log."""
    shown = "".join(f"<h2>{heading}</h2><section>{content}</section>\n" for heading, content in sections)
    path.write_text(f"""<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{escape(title)}</title><style>{STYLE}</style><main>
<header class="{'good' if good else 'bad'}"><h1>{escape(title)}</h1>
<p>{escape(summary)}</p></header>
{shown}</main><script>{SCRIPT}</script></html>
""", encoding="utf-8")


def write(scenario, flight, verdicts, interrupted, merged, folder):
    """`merged` is empty, or says why there is no flight.mcap."""
    shown = save_pictures(scenario, flight, folder)
    good = not interrupted and all(verdict.good for verdict in verdicts)
    word = "interrupted" if interrupted else "passed" if good else "failed"
    wrong = sum(not verdict.good for verdict in verdicts)
    counted = f"{len(verdicts) - wrong} of {len(verdicts)} expectations met"
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    notes = "".join(f"<p>{escape(note)}</p>" for note in flight.notes + ([f"no flight.mcap: {merged}"] if merged else []))
    write_page(folder / "report.html", f"{scenario.path.stem}: {word}", good,
               f"{counted if not interrupted else 'stopped by hand'} · {len(scenario.fleet())} nodes · {flight.end:.1f} s · {now}",
               [("Expectations", verdict_rows(scenario, verdicts) + notes), ("Events", event_rows(flight)),
                ("Over time", '<p class="faint">Dashed lines have the numbers of the events; grey times are faults that last. Point at '
                              f"them for their names.</p>{shown}"),
                ("Channels", census(scenario, flight)), ("Log", log_section(flight)),
                ("Scenario", f"<pre>{escape((folder / 'scenario.yaml').read_text(encoding='utf-8'))}</pre>"),
                ("Files", file_rows(folder, RUN_FILES))])
