"""Drives the read_print tutorial through pipes and checks what its README says.

Usage: read_print_test.py PATH_OF_READ_PRINT

No result depends on how fast anything is: each step waits for a line of output, and a line that never comes ends the
test after a generous time.
"""

import os
import pty
import queue
import signal
import subprocess
import sys
import threading
import unittest

PROGRAM = None
PATIENCE_SEC = 300


class Session:
    """A running read_print whose output is read by a thread of its own."""

    def __init__(self, *options):
        self.process = subprocess.Popen([PROGRAM, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, bufsize=1)
        self.seen = []
        self._lines = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()
        self.wait_for("PrintManager is waiting for a Message")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                stream.close()
            except BrokenPipeError:
                pass

    def _read(self):
        for line in self.process.stdout:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)

    def write(self, *lines):
        """Writes the lines with one system call."""
        self.process.stdin.write("".join(line + "\n" for line in lines))
        self.process.stdin.flush()

    def wait_for(self, wanted):
        while True:
            try:
                line = self._lines.get(timeout=PATIENCE_SEC)
            except queue.Empty:
                raise AssertionError(f"'{wanted}' was not printed; so far: {self.seen}") from None
            if line is None:
                raise AssertionError(f"the program ended before it printed '{wanted}'; it printed {self.seen}")
            self.seen.append(line)
            if line == wanted:
                return

    def finish(self):
        """Waits for the end of the program; returns its exit code."""
        while (line := self._lines.get(timeout=PATIENCE_SEC)) is not None:
            self.seen.append(line)
        return self.process.wait(timeout=PATIENCE_SEC)

    def seen_with(self, prefix):
        return [line[len(prefix):] for line in self.seen if line.startswith(prefix)]


class ReadPrint(unittest.TestCase):

    def assert_shut_down_cleanly(self, session):
        self.assertEqual(session.finish(), 0)
        self.assertEqual(session.seen.count("ReadManager: shut down"), 1)
        self.assertEqual(session.seen.count("PrintManager: shut down"), 1)
        self.assertEqual(session.process.stderr.read(), "")

    def test_only_the_last_of_several_quick_posts_is_printed_when_the_timer_is_slow(self):
        with Session("--period", "3600") as session:
            session.write("queue first")
            session.wait_for("queued: queue first")
            posts = [f"post {i}" for i in range(300)]
            session.write(*posts)
            session.write("queue last")
            session.wait_for("queued: queue last")
            session.write("quit")
            self.assert_shut_down_cleanly(session)
            printed = session.seen_with("posted: ")
            self.assertEqual(printed[-1], posts[-1])
            # The wake-up by the first message of the queue may have caused one more pass in between.
            self.assertLessEqual(len(printed), 2)

    def test_each_post_is_printed_at_once_when_posts_wake_the_printing_manager(self):
        with Session("--period", "3600", "--wake-on-post") as session:
            for i in range(20):
                session.write(f"post {i}")
                session.wait_for(f"posted: post {i}")
            session.write("quit")
            self.assert_shut_down_cleanly(session)
            self.assertEqual(session.seen_with("posted: "), [f"post {i}" for i in range(20)])

    def test_every_message_of_the_queue_is_printed_in_order_and_at_once(self):
        with Session("--period", "3600") as session:
            lines = [f"queue {i}" for i in range(500)]
            session.write(*lines)
            session.wait_for("queued: " + lines[-1])
            session.write("quit")
            self.assert_shut_down_cleanly(session)
            self.assertEqual(session.seen_with("queued: "), lines)

    def test_without_the_automatic_wake_up_the_messages_of_the_queue_are_printed_when_the_timer_expires(self):
        with Session("--period", "0.3", "--no-wake-on-queue") as session:
            lines = [f"queue {i}" for i in range(100)]
            session.write(*lines)
            session.wait_for("queued: " + lines[-1])
            session.write("quit")
            self.assert_shut_down_cleanly(session)
            self.assertEqual(session.seen_with("queued: "), lines)

    def test_the_words_count_at_the_begin_of_a_line_in_any_case_and_with_blanks_around(self):
        for word in ("quit", "EXIT", "  Quit  ", "\texit now", "Quitting"):
            with self.subTest(word), Session("--period", "3600", "--wake-on-post") as session:
                session.write("  Queue one ")
                session.wait_for("queued: Queue one")
                session.write("the queue")
                session.wait_for("posted: the queue")
                session.write("do not quit")
                session.wait_for("posted: do not quit")
                session.write(word)
                self.assert_shut_down_cleanly(session)

    def test_it_says_that_it_waits_after_what_it_printed(self):
        with Session("--period", "3600") as session:
            session.write("queue one")
            session.wait_for("queued: queue one")
            session.wait_for("PrintManager is waiting for a Message")
            session.write("quit")
            self.assert_shut_down_cleanly(session)

    def test_lines_of_both_managers_stay_whole_when_both_speak_at_once(self):
        # Both managers report their shutdown at the same moment, so twenty rounds would show a torn line.
        for _ in range(200):
            output = subprocess.run([PROGRAM, "--period", "3600"], input="quit\n", stdout=subprocess.PIPE, text=True,
                                    timeout=PATIENCE_SEC, check=True).stdout
            self.assertEqual(sorted(output.splitlines()), ["PrintManager is waiting for a Message",
                                                           "PrintManager: shut down", "ReadManager: shut down"])

    def test_a_terminal_gets_a_prompt_for_each_line_and_a_pipe_none(self):
        master, terminal = pty.openpty()
        with subprocess.Popen([PROGRAM], stdin=terminal, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            os.write(master, b"one\nquit\n")
            output, _ = process.communicate(timeout=PATIENCE_SEC)
        os.close(master)
        os.close(terminal)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(output.count("Type a line (quit or exit ends): "), 2)
        with Session() as session:
            session.write("one", "quit")
            self.assert_shut_down_cleanly(session)
            self.assertEqual([line for line in session.seen if "Type a line" in line], [])

    def test_the_end_of_the_input_shuts_down_and_nothing_is_lost(self):
        with Session("--period", "3600", "--no-wake-on-queue") as session:
            session.write("queue 1", "queue 2", "post 1")
            session.process.stdin.close()
            self.assert_shut_down_cleanly(session)
            self.assertEqual(session.seen_with("queued: "), ["queue 1", "queue 2"])
            self.assertEqual(session.seen_with("posted: "), ["post 1"])

    def test_signals_shut_down_cleanly(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number), Session("--period", "3600") as session:
                session.process.send_signal(number)
                self.assert_shut_down_cleanly(session)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main(verbosity=2)
