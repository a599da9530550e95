#!/usr/bin/env python3
"""Tests of the programs that run the night and judge its age, without any test of the night."""

import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import check  # noqa: E402
import parts  # noqa: E402
import run  # noqa: E402
import quiet  # noqa: E402  run.py adds its folder

SOUND = {"commit": "c0ffee", "date": "2026-01-02", "seconds": 9, "passed": 3, "failed": [], "skipped": {}}


class FakeHistory:
    def __init__(self, age, is_shallow=False):
        self._age = age
        self._is_shallow = is_shallow

    def is_shallow(self):
        return self._is_shallow

    def commits_since(self, _commit, _paths):
        return self._age


class Judging(unittest.TestCase):
    def wrong(self, known=(), age=0, **changes):
        return check.judge("tool", SOUND | changes, known, age)[1]

    def test_a_green_young_part_is_sound(self):
        self.assertEqual(self.wrong(age=check.OLDEST - 1), [])

    def test_a_part_of_too_many_commits_is_refused(self):
        self.assertEqual(len(self.wrong(age=check.OLDEST)), 1)

    def test_a_part_at_a_commit_that_git_does_not_know_is_refused(self):
        self.assertEqual(len(self.wrong(age=None)), 1)

    def test_a_part_without_an_entry_is_refused(self):
        self.assertEqual(len(check.judge("tool", None, {}, None)[1]), 1)

    def test_a_red_test_is_refused_until_its_cause_is_known(self):
        self.assertEqual(len(self.wrong(failed=["a.b"])), 1)
        self.assertEqual(self.wrong(failed=["a.b"], known={"a.b": "the vendor's fault 17"}), [])

    def test_a_third_skip_in_a_row_without_a_reason_is_refused(self):
        self.assertEqual(self.wrong(skipped={"a.b": {"reason": "", "runs": 2}}), [])
        self.assertEqual(len(self.wrong(skipped={"a.b": {"reason": "", "runs": 3}})), 1)
        self.assertEqual(self.wrong(skipped={"a.b": {"reason": "no browser", "runs": 9}}), [])

    def test_a_clone_without_history_is_told_and_not_refused(self):
        said = []
        self.assertTrue(check.check({"tool": {}}, {}, {}, FakeHistory(0, is_shallow=True), said.append))
        self.assertEqual(len(said), 1)

    def test_each_part_is_named_with_its_age(self):
        said = []
        self.assertTrue(check.check({"tool": {}}, {"tool": SOUND}, {}, FakeHistory(7), said.append))
        self.assertEqual(said, ["night: tool: 2026-01-02, 3 passed, 0 failed, 0 skipped, 7 commits old"])

    def test_a_cause_is_read_only_with_a_text(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "known.md"
            path.write_text("# Known\n- `a.b`: the vendor's fault 17\n- `c.d`:\n", encoding="utf-8")
            self.assertEqual(parts.known(path), {"a.b": "the vendor's fault 17"})


class Git(unittest.TestCase):
    def test_changed_files_are_named_from_the_root(self):
        with tempfile.TemporaryDirectory() as root:
            def git(*arguments):
                subprocess.run(("git", "-C", root, "-c", "user.name=a", "-c", "user.email=a@b", *arguments), check=True,
                               capture_output=True)
            file = pathlib.Path(root, "tests", "results.json")
            file.parent.mkdir()
            file.write_text("1", encoding="utf-8")
            git("init")
            git("add", ".")
            git("commit", "-m", "one")
            self.assertEqual(parts.History(root).changed_files(), [])
            file.write_text("2", encoding="utf-8")
            self.assertEqual(parts.History(root).changed_files(), ["tests/results.json"])


class Results(unittest.TestCase):
    ENDED = {"a": ["passed", "", 1.4], "b": ["failed", "", 2.0], "c": ["skipped", "no browser", 0.1]}

    def test_tests_are_counted_by_how_they_ended(self):
        result = run.result_of(self.ENDED, "c0ffee", "2026-01-02", None)
        self.assertEqual((result["passed"], result["failed"], result["seconds"]), (1, ["b"], 4))

    def test_runs_in_a_row_in_which_a_test_was_skipped_are_counted(self):
        first = run.result_of(self.ENDED, "c0ffee", "2026-01-02", None)
        second = run.result_of(self.ENDED, "c0ffef", "2026-01-03", first)
        self.assertEqual(second["skipped"], {"c": {"reason": "no browser", "runs": 2}})

    def test_a_part_is_due_if_it_never_ran_or_its_subject_was_touched(self):
        all_parts = {"ran": {"touches": []}, "never": {"touches": []}}
        ran = {"ran": SOUND, "never": SOUND | {"date": ""}}
        self.assertEqual(run.due(all_parts, ran, FakeHistory(0)), ["never"])
        self.assertEqual(run.due(all_parts, ran, FakeHistory(1)), ["never", "ran"])

    def test_each_part_is_described_and_has_an_entry_in_the_results(self):
        for name, part in parts.parts().items():
            self.assertTrue(part["about"] and part["touches"], name)
            self.assertIn(name, parts.results())


class Running(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.path = pathlib.Path(self._folder.name) / "progress.json"

    def outcome(self, text):
        path = pathlib.Path(self._folder.name) / "junit.xml"
        path.write_text(f"<testsuite>{text}</testsuite>", encoding="utf-8")
        return run.outcome_of(path)

    def test_an_outcome_is_read_with_the_reason_of_a_skip(self):
        self.assertEqual(self.outcome('<testcase name="a" status="run"/>'), ("passed", ""))
        self.assertEqual(self.outcome('<testcase name="a" status="fail"><failure/></testcase>'), ("failed", ""))
        mark = '<skipped message="SKIP_RETURN_CODE=77"/>'
        self.assertEqual(self.outcome(f'<testcase name="a" status="notrun">{mark}<system-out>x\nskipped: no npm; install npm\n'
                                      '</system-out></testcase>'), ("skipped", "no npm; install npm"))
        self.assertEqual(self.outcome(f'<testcase name="a" status="notrun">{mark}</testcase>'), ("skipped", ""))

    def test_a_test_whose_program_is_missing_has_failed(self):
        self.assertEqual(self.outcome('<testcase name="a" status="notrun"><skipped message="Unable to find executable"/></testcase>'),
                         ("failed", ""))

    def test_a_test_that_ctest_did_not_find_has_failed(self):
        self.assertEqual(self.outcome("")[0], "failed")

    def test_a_run_goes_on_at_the_same_commit_and_begins_anew_at_another(self):
        run.Progress(self.path, "c0ffee", False).add("a", "failed", "", 1.0)
        self.assertEqual(run.Progress(self.path, "c0ffee", False).ended(), {"a": ["failed", "", 1.0]})
        self.assertEqual(run.Progress(self.path, "c0ffef", False).ended(), {})
        self.assertEqual(run.Progress(self.path, "c0ffee", True).ended(), {})

    def test_no_test_starts_after_the_time_is_over(self):
        progress = run.Progress(self.path, "c0ffee", False)
        run.Runner("nowhere", self.path.parent, progress, time.monotonic() - 1).run([run.Test({"name": "a"})], 1)
        self.assertEqual(progress.ended(), {})

    def test_a_timed_test_is_alone(self):
        description = {"name": "a", "properties": [{"name": "LABELS", "value": ["night", "timed"]}]}
        self.assertTrue(run.Test(description).is_alone)


class Load:
    """Shares of a processor, one for each measurement."""

    def __init__(self, shares):
        self._shares = iter(shares)

    def __call__(self):
        return self

    def share(self):
        return next(self._shares)


class Quiet(unittest.TestCase):
    def test_waiting_ends_with_the_first_quiet_measurement(self):
        self.assertEqual(quiet.wait_until_quiet(600, Load([1.5, 0.4, 0.1, 9.0]), lambda _: None), 0.1)

    def test_waiting_ends_when_its_time_is_over(self):
        self.assertEqual(quiet.wait_until_quiet(10, Load([1.5, 0.4, 0.1]), lambda _: None), 0.4)


if __name__ == "__main__":
    unittest.main()
