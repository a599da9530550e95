#!/usr/bin/env python3
"""Checks that check_comments.py finds what it is there to find."""

import pathlib
import tempfile
import unittest

import check_comments


class CheckComments(unittest.TestCase):
    def lines_with_a_fault(self, text):
        return [number for number, _ in check_comments.faults(text.splitlines())]

    def test_a_long_last_line_without_a_stop_was_cut(self):
        self.assertEqual(self.lines_with_a_fault("""\
// Opens the file. Returns false if the folder is not there.
// The file is written by one thread alone, and each record goes into the next chunk
int Open();
"""), [2])

    def test_a_last_word_that_ends_no_sentence_was_cut(self):
        self.assertEqual(self.lines_with_a_fault("// Opens the file. Returns false if\n// there is no room in the\n"), [2])

    def test_a_first_word_that_begins_no_sentence_was_cut(self):
        self.assertEqual(self.lines_with_a_fault("// and closes the file.\n// Returns its size.\n"), [1])

    def test_a_line_that_does_not_lead_to_the_next_one_was_cut(self):
        self.assertEqual(self.lines_with_a_fault("""\
    // Makes a writer. Throws TransportError if the topic is open with another type in
    // Does not wait for readers.
"""), [1])

    def test_what_is_whole_passes(self):
        self.assertEqual(self.lines_with_a_fault("""\
// Opens the file, and tells whether
// TransportError is known. Units:
//
//   rate BITS        of the whole medium, also if it is changed later, by another program
//   queue BYTES      what a queue holds
//
// - the first of a list, which has no stop at its end, as lists in this house do not have
// Returns the size (in bytes).
int Open();  // short
// too. Must reach no parser
// of a vendor
"""), [])

    def test_a_violation_names_file_and_line(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "core/src/A.h"
            file.parent.mkdir(parents=True)
            file.write_text("// Reads.\n// Ends in the\n")
            self.assertEqual(list(check_comments.violations(pathlib.Path(folder))),
                             ["core/src/A.h:2: this comment ends in the middle of a sentence: Ends in the"])


if __name__ == "__main__":
    unittest.main()
