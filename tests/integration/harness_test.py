#!/usr/bin/env python3
"""The harness counts what other programs took, and no more."""

import pathlib
import tempfile
import unittest

import harness

VERDICTS = """<testsuite>
<testcase name="no node ends by itself"><failure message="uav1 ended by itself with -11 at 9.0 s: a | b; uav2 ended by itself with 1 at 9 s"/></testcase>
<testcase name="exit codes: 0"><failure message="{exits}"/></testcase>
<testcase name="uav3 up within 2s"><failure message="uav3 ended with 5"/></testcase>
</testsuite>"""


class IdleTest(unittest.TestCase):
    def share(self, idle, ours, all_of_it, **how):
        class Told(harness.Idle):
            times = [(10, 10, 100), (10 + idle, 10 + ours, 100 + all_of_it)]

            def _now(self):
                return self.times.pop(0)
        return Told().share(**how)

    def test_other_programs_make_the_machine_busy(self):
        self.assertEqual(self.share(20, 10, 100), 0.3)

    def test_nodes_that_never_rest_do_not(self):
        self.assertEqual(self.share(0, 90, 100), 0.9)

    def test_what_runs_at_the_same_time_does_if_the_test_says_so(self):
        self.assertEqual(self.share(20, 70, 100, with_ours=True), 0.2)


class EndedBadlyTest(unittest.TestCase):
    def ended_badly(self, exits):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "again").mkdir()
            pathlib.Path(folder, "again", "junit.xml").write_text(VERDICTS.format(exits=exits), encoding="utf-8")
            return harness.ended_badly(folder)

    def test_names_the_nodes_that_ended_by_themselves_or_with_another_code(self):
        self.assertEqual(self.ended_badly("uav4 ended with 3"), {"uav1", "uav2", "uav4"})

    def test_leaves_out_a_node_that_is_slow_to_end(self):
        self.assertEqual(self.ended_badly("uav4 did not end within 10 s of SIGTERM"), {"uav1", "uav2"})


class WaitsTest(unittest.TestCase):
    def test_counts_from_the_last_look_before_to_the_first_look_after(self):
        waits = harness.Waits.__new__(harness.Waits)  # without its thread
        waits._looks = [(1, 2, 0.0), (3, 4, 5.0), (5, 6, 7.0), (7, 8, 8.0)]  # pylint: disable=protected-access
        for begin, end, waited in ((4.5, 4.6, 2.0), (3.5, 4.6, 7.0), (4.5, 5.5, 3.0), (0, 9, 8.0)):
            self.assertEqual(waits.between(begin, end), waited)


if __name__ == "__main__":
    unittest.main()
