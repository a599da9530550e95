#!/usr/bin/env python3
"""The figures of the radio's table from ledgers and counters that are made up."""

import figures
import measures
import radio_table
import rows

import expectations  # found by measures

S = 1_000_000_000
START = "{} start node={} life=1 room=50\n"


def ledgers(**texts):
    return expectations.Run(texts, [])


def shown_age_grows_between_ticks_and_is_infinite_before_the_first():
    text = START.format(0, "ground") + f"{1 * S} tick from=uav1 number=1 age_s=0.5\n"
    ages = figures.shown_ages(ledgers(ground=text, uav1=START.format(0, "uav1")), 0.95, 2.0)
    assert ages[-1] == float("inf") and ages[0] < 0.56 and 1.3 < ages[-2] < 1.5, ages


def commands_that_never_come_count_as_open_and_those_of_other_times_do_not():
    ground = START.format(0, "ground") + "".join(f"{k * S} accepted to=uav1 id={k}\n" for k in range(1, 6))
    uav1 = START.format(0, "uav1") + f"{2 * S + S // 2} delivered from=ground life=1 id=2\n" \
        f"{5 * S} delivered from=ground life=1 id=1\n{9 * S} delivered from=ground life=1 id=5\n"
    delays, missing = figures.command_delays(ledgers(ground=ground, uav1=uav1), 2, 5)
    assert (delays, missing) == ([0.5], 2), (delays, missing)


def the_share_of_ticks_is_of_those_between_the_first_and_the_last_that_were_seen():
    ground = START.format(0, "ground") + "".join(f"{k * S} tick from=uav1 number={k} age_s=0.1\n" for k in (3, 4, 6))
    run = ledgers(ground=ground, uav1=START.format(0, "uav1"))
    assert (measures.share_of_ticks(run, "ground", "uav1"), measures.share_of_ticks(run, "uav1", "ground")) == (0.75, 0.0)


def percentiles_are_of_the_sorted_values():
    values = list(range(200))
    assert [figures.percentile(values, p) for p in (50, 99)] == [100, 198]
    assert figures.percentile([7], 99) == 7 and figures.percentile([], 99) is None
    assert figures.percentile([1, float("inf")], 99) is None and figures.percentile([1, float("inf")], 49) == 1


def traffic_is_what_was_offered_by_the_time_and_the_rate():
    node = {"offered": {"bytes": 1000}, "dropped": {"bytes": 250}, "longest_wait_ms": 3}
    found = figures.traffic({"seconds": 2, "bits_per_s": 16_000, "utilisation": 0.5, "sent": {"bytes": 1500},
                                "nodes": {"a": node, "b": {**node, "longest_wait_ms": 5}}})
    assert found == {"offered_kB_s": 1, "sent_kB_s": 0.75, "dropped_pct": 25, "used_pct": 50, "longest_wait_ms": 5,
                     "offered_pct": 50}, found


def a_limit_is_missed_by_a_worse_figure_and_by_none():
    row = rows.Row("", {}, "", {}, {"share": (">=", 95), "delay": ("<=", 5)})
    assert radio_table.missed(row, {"share": 95, "delay": 5}) == []
    assert len(radio_table.missed(row, {"share": 94.9, "delay": 5.1})) == 2
    assert radio_table.missed(row, {"share": 99, "delay": None}) == ["delay never, <= 5 wanted"]
    assert len(radio_table.missed(row, {"share": 99, "delay": float("inf")})) == 1


GROUND = """    1.0 s  uav1   UP      pose (age 0.00 s) 47.3954407 8.5440314 505.0 m 12.1 m/s, mission TRANSIT, commands 1 sent
    1.0 s  uav2   UP      no pose yet, mission unknown, commands 0 sent 0 acknowledged
    1.0 s  2 problems: subscribe Targets (uav1), subscribe CameraView (uav1)
    2.0 s  uav2   STALE ! pose (age 2.51 s) 47.3954407 8.5440314 505.0 m 12.1 m/s, mission TRANSIT, commands 1 sent
    3.0 s  uav2   UP      pose (age 0.10 s) 47.3954407 8.5440314 505.0 m 12.1 m/s, mission TRANSIT, commands 1 sent
Summary after 6.1 s
  uav1  UP  heard 50 of 50 poses (100.0 %), commands 1 sent 1 acknowledged
  uav2  UP  heard 46 of 50 poses (92.0 %), commands 1 sent 1 acknowledged"""
LINES = [(0, line) for line in GROUND.splitlines()]


def the_ground_stations_lines_are_read():
    shown = figures.shown_rows(LINES)
    assert [(row.time, row.node, row.state, row.age) for row in shown] == [
        (1, "uav1", "UP", 0), (1, "uav2", "UP", float("inf")), (2, "uav2", "STALE", 2.51), (3, "uav2", "UP", 0.1)], shown
    assert figures.poses_heard(LINES) == 92 and figures.poses_heard([]) is None


def a_fleet_is_up_when_each_was_up_with_a_pose():
    shown = figures.shown_rows(LINES)
    assert figures.first_all_up(shown, ["uav1", "uav2"]) == 3
    assert figures.first_all_up(shown[:3], ["uav1", "uav2"]) is None


def every_row_can_be_measured():
    for row in rows.ROWS:
        assert callable(radio_table.measure_of(row)), row.name
        assert measures.nodes_of(row), row.name
    assert len({row.name for row in rows.ROWS}) == len(rows.ROWS), "two rows of one name"


def the_table_has_a_column_for_each_figure_of_a_measure():
    results = [{"row": "r", "measure": "m", "program": "p", "figures": {"x_pct": 1.234, "y_s": None}, "missed": ["w"]}]
    assert radio_table.table(results) == ("| what | program | x, % | y s | missed |\n|---|---|---|---|---|\n"
                                          "| r | p | 1.23 | never | w |\n")


def main():
    for test in (shown_age_grows_between_ticks_and_is_infinite_before_the_first,
                 commands_that_never_come_count_as_open_and_those_of_other_times_do_not,
                 the_share_of_ticks_is_of_those_between_the_first_and_the_last_that_were_seen,
                 percentiles_are_of_the_sorted_values, traffic_is_what_was_offered_by_the_time_and_the_rate,
                 the_ground_stations_lines_are_read, a_fleet_is_up_when_each_was_up_with_a_pose,
                 a_limit_is_missed_by_a_worse_figure_and_by_none, every_row_can_be_measured,
                 the_table_has_a_column_for_each_figure_of_a_measure):
        test()
        print(f"ok: {test.__name__}")


if __name__ == "__main__":
    main()
