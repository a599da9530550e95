#!/usr/bin/env python3
"""The soak's verdicts find what is wrong, and have nothing against what is right."""

import unittest

import expectations
import judge
import soak

S = 1_000_000_000
END_S = 100


def life(node, *said, begin=1):
    """`said`: (second, other node, state, seconds since it was heard)"""
    lines = [f"{begin * S} start node={node} life={begin} room=5\n"]
    lines += [f"{int(at * S)} peer node={other} state={state} heard_s={heard}\n" for at, other, state, heard in said]
    return judge.read_ledger(lines)


def presence(lives, *faults):
    run = expectations.Run({}, list(faults))
    run.lives = lives
    return soak.PresenceTruth(run, END_S).wrong()


def samples(rss_kb, cpu_percent, yardstick_ms=None):
    return [{**{node: {"rss_kb": rss, "cpu_percent": cpu} for node in soak.LONG_LIVED}, "yardstick_ms": yardstick}
            for rss, cpu, yardstick in zip(rss_kb, cpu_percent, yardstick_ms or [2] * len(rss_kb))]


class PresenceTest(unittest.TestCase):
    def wrong(self, word, found):
        self.assertTrue(any(word in text for text in found), f"{word!r} not in {found}")

    def test_accepts_who_saw_a_kill_and_the_return(self):
        b = life("b", (2, "a", "UP", 0)) + life("b", (41, "a", "UP", 0), begin=40)
        a = life("a", (2, "b", "UP", 0), (32, "b", "STALE", 1.5), (34, "b", "LOST", 3.5), (41, "b", "UP", 0))
        self.assertEqual(presence({"a": a, "b": b}, (30, "kill", ["b"])), [])

    def test_finds_lost_of_a_node_that_lives(self):
        a = life("a", (2, "b", "UP", 0), (34, "b", "LOST", 3.5), (41, "b", "UP", 0))
        self.wrong("a showed b LOST", presence({"a": a, "b": life("b", (2, "a", "UP", 0))}))

    def test_leaves_out_what_was_said_while_the_machine_stood_still(self):
        a = life("a", (2, "b", "UP", 0), (34, "b", "LOST", 3.5), (35, "b", "UP", 0))
        run = expectations.Run({}, [])
        run.lives = {"a": a, "b": life("b", (2, "a", "UP", 0))}
        self.assertEqual(soak.PresenceTruth(run, END_S, [(28, 33)]).wrong(), [])
        self.assertEqual(len(soak.PresenceTruth(run, END_S, [(20, 25)]).wrong()), 1)

    def test_finds_stale_of_a_node_that_was_heard(self):
        a = life("a", (2, "b", "UP", 0), (34, "b", "STALE", 0.5), (35, "b", "UP", 0))
        self.wrong("shown STALE, heard 0.5 s before", presence({"a": a, "b": life("b", (2, "a", "UP", 0))}))

    def test_finds_more_stale_than_the_loss_explains(self):
        flapping = [(10 + i / 10, "b", state, 1.6) for i in range(200) for state in ("STALE", "UP")]
        a = life("a", (2, "b", "UP", 0), *flapping)
        self.wrong("the loss explains", presence({"a": a, "b": life("b", (2, "a", "UP", 0))}))

    def test_finds_a_kill_that_was_not_shown(self):
        b = life("b", (2, "a", "UP", 0)) + life("b", (41, "a", "UP", 0), begin=40)
        self.wrong("not shown LOST", presence({"a": life("a", (2, "b", "UP", 0)), "b": b}, (30, "kill", ["b"])))

    def test_finds_a_return_that_was_not_shown(self):
        b = life("b", (2, "a", "UP", 0)) + life("b", (41, "a", "UP", 0), begin=40)
        a = life("a", (2, "b", "UP", 0), (34, "b", "LOST", 3.5), (70, "b", "UP", 0))
        self.wrong("not shown UP within 15.0 s", presence({"a": a, "b": b}, (30, "kill", ["b"])))

    def test_finds_a_living_node_not_shown_up_at_the_end(self):
        a = life("a", (2, "b", "UP", 0), (99, "b", "STALE", 1.6))
        self.wrong("shown STALE at the end", presence({"a": a, "b": life("b", (2, "a", "UP", 0))}))


class CostTest(unittest.TestCase):
    def test_accepts_what_stays(self):
        self.assertEqual(soak.judge_memory(samples([90] * 4 + [100] * 51 + [102] * 5, [5] * 60)), [])
        self.assertEqual(soak.judge_processor(samples([100] * 60, [9] * 20 + [5] * 20 + [5.4] * 20)), [])

    def test_finds_memory_that_grows(self):
        self.assertEqual(len(soak.judge_memory(samples([100] * 55 + [103] * 5, [5] * 60))), len(soak.LONG_LIVED))

    def test_accepts_memory_of_a_moment(self):
        self.assertEqual(soak.judge_memory(samples([100] * 59 + [103], [5] * 60)), [])

    def test_finds_processor_time_that_grows(self):
        self.assertEqual(len(soak.judge_processor(samples([100] * 60, [5] * 40 + [5.6] * 20))), len(soak.LONG_LIVED))

    def test_accepts_processor_time_that_grows_with_that_of_all_work(self):
        self.assertEqual(soak.judge_processor(samples([100] * 60, [5] * 40 + [6] * 20, [2] * 40 + [2.4] * 20)), [])

    def test_finds_processor_time_that_grows_while_other_work_gets_quicker(self):
        self.assertEqual(len(soak.judge_processor(samples([100] * 60, [5] * 60, [2.4] * 40 + [2] * 20))),
                         len(soak.LONG_LIVED))

    def test_leaves_out_samples_without_a_measurement_of_the_yardstick(self):
        missing = [None] * 20 + [2] * 20 + [None, 2] * 10
        self.assertEqual(soak.judge_processor(samples([100] * 60, [5] * 40 + [50, 5] * 10, missing)), [])

    def test_judges_nothing_without_a_measurement_of_the_yardstick(self):
        self.assertEqual(soak.judge_processor(samples([100] * 60, [5] * 60, [None] * 60)), [])

    def test_percentiles(self):
        self.assertEqual(soak.percentiles([k / 1000 for k in range(100)]),
                         {"count": 100, "p50_ms": 50.0, "p99_ms": 99.0, "max_ms": 99.0})


if __name__ == "__main__":
    unittest.main()
