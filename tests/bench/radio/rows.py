"""The rows of the table: on which medium which fleet has to do what, how well at least. Each row names the function of
measures.py or meeting.py that measures it; the figures of that function are the columns."""

from dataclasses import dataclass, field

PLAIN = "plain"
RABIT = "Rabit"
MIXED = "mixed"  # a transport: both backends

WIDE = {"kbit": 100_000}


@dataclass
class Row:
    name: str
    medium: dict
    measure: str
    options: dict
    # figure -> (comparison, limit), for Rabit; a plain program has no limits.
    limits: dict = field(default_factory=dict)
    plain: bool = False
    long: bool = False

    def kbit(self):
        return self.medium.get("kbit", 0)


def members(kbit, limits=None):
    return Row(f"five members all to all, 100 B at 10 Hz, {kbit} kbit/s", {"kbit": kbit}, "all_to_all",
               {"members": 5, "settle_s": 15, "seconds": 30}, limits or {}, plain=True)


def idle(size):
    return Row(f"idle, N = {size}", WIDE, "idle", {"nodes": size, "settle_s": 15, "seconds": 20},
               {"ip_kB_s": ("<=", round(0.3 * size + 0.02 * size * (size - 1), 2))}, plain=True)


def fleet(uavs, kbit, limits, seconds=60):
    """A ground station that sends two commands a second to each aircraft, and aircraft that publish a pose ten times a
    second, which all others follow."""
    return Row(f"{uavs}+1, {kbit} kbit/s", {"kbit": kbit}, "fly",
               {"uavs": uavs, "seconds": seconds, "a_second": 2}, limits, long=seconds > 60)


def swarm(uavs, kbit, limits, seconds=60):
    """The example programs, as demo.sh starts them but for the cameras."""
    what = f"example, {uavs}+1, {kbit} kbit/s" + (f", {seconds // 60} minutes" if seconds > 60 else "")
    return Row(what, {"kbit": kbit}, "swarm", {"uavs": uavs, "seconds": seconds}, limits, long=seconds > 60)


def commands(loss, rate, p99):
    return Row(f"{rate} commands a second, {loss} % lost", {"loss": loss}, "commands",
               {"rate": rate, "count": min(10 * rate, 5000)}, {"p99_ms": ("<=", p99), "refused": ("<=", 0)})


def meet(loss, p99):
    return Row(f"two nodes meet, {loss} % lost, 10 Mbit/s", {"kbit": 10_000, "loss": loss}, "meet",
               {"members": 2, "tries": 100}, {"p99_s": ("<=", p99), "failed": ("<=", 0)}, plain=True, long=True)


def back(for_s, tries):
    """The way to more than a hundred tries: eight ways each time."""
    return Row(f"back after {for_s} s, five nodes, 250 kbit/s, 10 % lost", {"kbit": 250, "loss": 10}, "back",
               {"members": 5, "for_s": for_s, "tries": tries}, {"p99_s": ("<=", 1)}, long=True)


MEETING = [
    *(meet(loss, p99) for loss, p99 in ((0, 0.3), (20, 1), (40, 3))),
    back(45, 13),
    back(600, 2),
    Row("five nodes at once, 250 kbit/s, 10 % lost", {"kbit": 250, "loss": 10}, "crowd", {"members": 5, "tries": 20},
        {"p99_s": ("<=", 3), "failed": ("<=", 0)}, long=True),
    Row("one of six nodes starts again, 250 kbit/s, 10 % lost", {"kbit": 250, "loss": 10}, "restart", {"members": 6, "tries": 20},
        {"p99_s": ("<=", 3), "failed": ("<=", 0)}, long=True),
    swarm(10, 250, {"all_up_s": ("<=", 3), "lost": ("<=", 0), "poses_pct": (">=", 95)}),
    swarm(20, 1000, {"all_up_s": ("<=", 2), "lost": ("<=", 0), "poses_pct": (">=", 99)}),
    Row("churn: ten nodes, 1 Mbit/s, 10 % lost, one starts again every 3 s", {"kbit": 1000, "loss": 10}, "churn",
        {"members": 10, "seconds": 600, "every_s": 3}, {"p99_s": ("<=", 1), "lost": ("<=", 0)}, long=True),
]

ROWS = [
    *MEETING,
    members(10_000),
    members(1000),
    members(250, {"arrives_pct": (">=", 95)}),
    fleet(4, 1000, {"all_up_s": ("<=", 10), "ticks_pct": (">=", 95), "commands_p99_ms": ("<=", 200), "stale": ("<=", 0),
                    "offered_pct": ("<=", 50)}, 600),
    fleet(4, 250, {"all_up_s": ("<=", 20), "lost": ("<=", 0), "commands_p99_ms": ("<=", 500),
                   "age_p90_s": ("<=", 0.5)}, 600),
    fleet(10, 250, {"all_up_s": ("<=", 40), "lost": ("<=", 0), "commands_p99_ms": ("<=", 1000),
                    "age_p90_s": ("<=", 1)}),
    swarm(4, 10_000, {"all_up_s": ("<=", 5), "stale": ("<=", 0)}),
    swarm(4, 1000, {"all_up_s": ("<=", 10), "stale": ("<=", 0), "poses_pct": (">=", 95), "offered_pct": ("<=", 50)}),
    swarm(4, 250, {"all_up_s": ("<=", 20), "lost": ("<=", 0), "age_p90_s": ("<=", 0.5)}),
    swarm(4, 1000, {"all_up_s": ("<=", 10), "stale": ("<=", 0), "poses_pct": (">=", 95), "offered_pct": ("<=", 50)}, 600),
    swarm(4, 250, {"all_up_s": ("<=", 20), "lost": ("<=", 0), "age_p90_s": ("<=", 0.5)}, 600),
    Row("2+1 with bulk, 1 Mbit/s falls to 100 kbit/s for a minute", {"kbit": 1000}, "fall",
        {"uavs": 2, "to_kbit": 100, "for_s": 60}, {"wait_ms": ("<=", 300), "used_pct": (">=", 80)}, long=True),
    Row("2+1, a picture of 60 kB, 57.6 kbit/s, budget 1500 B/s", {"kbit": 57.6}, "picture",
        {"uavs": 2, "size": 60_000, "limit_s": 180, "budget": 1500},
        {"all_up_s": ("<=", 60), "picture_s": ("<=", 180), "age_max_s": ("<=", 3), "commands_p99_ms": ("<=", 3000),
         "lost": ("<=", 0)}, long=True),
    Row("4+1, ten times more offered than the budget of 5 kB/s", {"kbit": 1000}, "overload",
        {"uavs": 4, "budget": 5000, "times": 10, "seconds": 60},
        {"lost": ("<=", 0), "worst_second_pct": ("<=", 105), "p99_of_allowed_pct": ("<=", 100)}, long=True),
    Row("idle, N = 5, budget 1500 B/s", WIDE, "idle", {"nodes": 5, "settle_s": 30, "seconds": 60, "budget": 1500},
        {"ip_B_s_each": ("<=", 100)}, long=True),
    Row("4+1, outage of 60 s, 250 kbit/s", {"kbit": 250}, "outage", {"uavs": 4, "for_s": 60},
        {"first_age_s": ("<=", 1)}, long=True),
    *map(idle, (2, 5, 10, 20)),
    Row("idle, N = 2, round trip 600 ms", {**WIDE, "delay_ms": 300}, "idle",
        {"nodes": 2, "settle_s": 15, "seconds": 20}, {"ip_kB_s": ("<=", 0.64)}, plain=True),
    Row("a link of two nodes, three messages of 200 kB, 250 kbit/s", {"kbit": 250}, "link",
        {"payload": 200_000, "count": 3, "rate": 100, "limit_s": 120},
        {"seconds": ("<=", 21), "delivered": (">=", 3), "sent_per_payload": ("<=", 1.15)}),
    Row("a link of two nodes, 30 a second of 500 B, expiry 2 s, 250 kbit/s", {"kbit": 250}, "link",
        {"payload": 500, "count": 1000, "rate": 30, "expire": 2, "limit_s": 120},
        {"delivered": (">=", 1000), "sent_per_payload": ("<=", 1.15)}),
    Row("a link of two nodes, round trip 600 ms, 1 Mbit/s", {"kbit": 1000, "delay_ms": 300}, "throughput",
        {"payload": 1000, "seconds": 30}, {"goodput_pct": (">=", 70)}),
    *(commands(20, rate, 150) for rate in (10, 50, 200, 500)),
    commands(40, 50, 600),
    Row("a start of 10 at once, wide medium", WIDE, "start", {"members": 10}, {"ip_MB": ("<=", 0.4)}, plain=True),
    Row("a start of 10+1 at once, 10 % lost, 250 kbit/s", {"kbit": 250, "loss": 10}, "fly",
        {"uavs": 10, "seconds": 60, "a_second": 2}, {"all_up_s": ("<=", 60)}),
]
