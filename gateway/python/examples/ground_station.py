"""A ground station with a live plot: where the aircraft are, and how old that is.

    ground_station.py --idl uav.idl --domain 7 [--config ground.yaml] [--seconds 60 --picture plot.png]
"""

import argparse
import time

import matplotlib

import rabit

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--idl", required=True)
parser.add_argument("--domain", type=int, default=0)
parser.add_argument("--interface", action="append", default=[])
parser.add_argument("--transport", default="fastdds")
parser.add_argument("--seconds", type=float, default=1e9, help="ends then")
parser.add_argument("--picture", help="a file for the last plot; no window is opened")
options = parser.parse_args()
if options.picture:
    matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402

idl = rabit.load_idl(options.idl)
figure, axes = plot.subplots()
end = time.monotonic() + options.seconds
with rabit.Node("viewer", domain=options.domain, interfaces=options.interface, transport=options.transport) as node:
    poses = node.subscribe("uav?/Pose", idl.Uav.Pose)
    tracks: dict[str, tuple[list[float], list[float]]] = {}
    while time.monotonic() < end:
        axes.clear()
        for name, pose in poses.latest().items():
            east, north = tracks.setdefault(name, ([], []))
            east.append(pose.value.longitude_deg)
            north.append(pose.value.latitude_deg)
            fresh = pose.age < 2 and node.fleet().is_up(name)
            axes.plot(east, north, label=f"{name} {pose.value.altitude_m:.0f} m", alpha=1.0 if fresh else 0.3)
        axes.set(xlabel="longitude (deg)", ylabel="latitude (deg)", title=f"{len(tracks)} aircraft")
        axes.legend() if tracks else None
        plot.pause(0.2) if not options.picture else time.sleep(0.2)
if options.picture:
    figure.savefig(options.picture)
print(f"saw {', '.join(sorted(tracks)) or 'nobody'}")
