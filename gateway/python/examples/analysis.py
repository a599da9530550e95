"""Looks at a recorded flight: tracks, altitudes, and how old the poses were at other nodes. As a notebook: cells begin with
`# %%`.

    analysis.py RECORDING... --figures FOLDER [--wall-clock]
"""

# %% The recordings of several nodes come onto one time line.
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402

import rabit  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("recordings", nargs="+")
parser.add_argument("--wall-clock", action="store_true", help="for recordings whose clocks nothing relates, as of two flights")
parser.add_argument("--figures", type=pathlib.Path, default=pathlib.Path("."))
options = parser.parse_args()
flight = rabit.open(*options.recordings, wall_clock=options.wall_clock)
for topic in flight.topics:
    print(f"{topic.messages:8} {topic.name} ({topic.type})")

# %% The track and the altitude of each aircraft, from what it posted itself.
poses = {topic.name.partition("/")[0]: flight.to_pandas(topic.name)
         for topic in flight.topics if topic.type == "Uav::Pose" and topic.name.count("/") == 1}
figure, (track, height) = plot.subplots(1, 2, figsize=(11, 4))
for name, table in sorted(poses.items()):
    track.plot(table["longitude_deg"], table["latitude_deg"], label=name)
    height.plot(table.index, table["altitude_m"], label=name)
    print(f"{name}: {len(table)} poses, {table['altitude_m'].min():.0f} to {table['altitude_m'].max():.0f} m")
track.set(xlabel="longitude (deg)", ylabel="latitude (deg)", title="Tracks")
height.set(xlabel="time (UTC)", ylabel="altitude (m)", title="Altitudes")
track.legend()
figure.tight_layout()
figure.savefig(options.figures / "tracks.png")

# %% The age of the poses of others when they arrived. In a merged file these are `uav1/Recorder/knew/uav2/Pose`.
figure, axes = plot.subplots(figsize=(8, 4))
for topic in flight.topics:
    if topic.type == "Uav::Pose" and "/knew/" in topic.name:
        ages = [1000 * message.age for message in flight.messages(topic.name)]
        axes.plot(sorted(ages), [(i + 1) / len(ages) for i in range(len(ages))], label=topic.name)
axes.set(xlabel="age at arrival (ms)", ylabel="share of the poses", title="Ages")
figure.savefig(options.figures / "ages.png")
