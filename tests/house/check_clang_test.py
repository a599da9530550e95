#!/usr/bin/env python3
"""Checks that check_clang.py finds what it is there to find, and nothing else.

Usage: check_clang_test.py CLANG"""

import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest
import unittest.mock

import check_clang

CLANG = "clang"


class CheckClang(unittest.TestCase):
    def check(self, files, options="-Wall -Wextra", standard="-std=c++20", compiled=None):
        """What is said of these files, as a list of (name, text), and how many were checked. All are compiled, or some."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, text in files.items():
                (folder / name).parent.mkdir(exist_ok=True)
                (folder / name).write_text(text.replace("FOLDER", str(folder)))
            (folder / "compile_commands.json").write_text(json.dumps([
                {"directory": str(folder), "file": str(folder / name),
                 "command": f"ccache c++ -I {folder} {options} -O3 {standard} -o {name}.o -c {folder / name}"}
                for name in compiled or [name for name in files if name.endswith((".c", ".cpp"))]]))
            failures, units = check_clang.check(CLANG, folder, [], 1)
            return [(pathlib.Path(unit).name, said) for unit, said in failures], units

    def test_good_units_are_good(self):
        self.assertEqual(self.check({"A.cpp": "int A();\n", "B.cpp": "int B();\n"}), ([], 2))

    def test_a_warning_in_one_unit_of_many_is_found_and_said_of_that_unit_alone(self):
        failures, _ = self.check({"A.cpp": "int A() { return 1; }\n", "B.cpp": "int B(int unused) { return 1; }\n",
                                  "C.cpp": "int C() { return 1; }\n"})
        self.assertEqual([unit for unit, _ in failures], ["B.cpp"])
        self.assertIn("unused parameter", failures[0][1])

    def test_a_warning_that_g_does_not_have_is_found(self):
        failures, _ = self.check({"A.cpp": "class A { int _unused = 0; public: int F() { return 1; } };\nA a;\n"})
        self.assertIn("-Wunused-private-field", failures[0][1])

    def test_units_that_name_something_alike_are_read_apart(self):
        same = "namespace { int Same() { return 1; } }\nint %s() { return Same(); }\nint main() {}\n"
        self.assertEqual(self.check({"A.cpp": same % "A", "B.cpp": same % "B", "C.cpp": same % "C"}), ([], 3))

    def test_a_warning_is_found_beside_units_that_name_something_alike(self):
        same = "namespace { int Same() { return 1; } }\nint %s() { return Same(); }\n"
        failures, _ = self.check({"A.cpp": same % "A", "B.cpp": same % "B", "C.cpp": "static int Unused() { return 1; }\n"})
        self.assertEqual([unit for unit, _ in failures], ["C.cpp"])

    def test_a_fault_in_a_header_is_found(self):
        failures, _ = self.check({"A.h": "#pragma once\nstruct A { int F(int unused) { return 1; } };\n",
                                  "A.cpp": '#include "A.h"\n', "B.cpp": '#include "A.h"\n'})
        self.assertEqual([unit for unit, _ in failures], ["A.cpp", "B.cpp"])

    def test_a_unit_is_read_with_the_options_of_its_target(self):
        text = {"A.cpp": "int A(int unused) { return 1; }\n"}
        self.assertEqual(self.check(text, options="-Wall -Wextra -Wno-unused-parameter"), ([], 1))
        self.assertEqual(self.check(text, options="-w"), ([], 0))

    def test_units_that_the_build_compiles_as_one_are_read_by_themselves(self):
        files = {"A.cpp": "int A(int unused) { return 1; }\n", "B.cpp": "int B() { return 1; }\n",
                 "Unity/unity_0_cxx.cxx": '/* generated */\n\n#include "FOLDER/A.cpp"\n\n#include "FOLDER/B.cpp"\n'}
        failures, units = self.check(files, compiled=["Unity/unity_0_cxx.cxx"])
        self.assertEqual(([unit for unit, _ in failures], units), (["A.cpp"], 2))

    def test_c_is_read_as_c(self):
        self.assertEqual(self.check({"A.c": "int class = 0;\n", "B.c": "int class = 0;\n"}, standard="-std=gnu11"), ([], 2))


@unittest.skipUnless(shutil.which("ccache"), "no ccache here")
class WhatIsRemembered(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        cache = unittest.mock.patch.dict(os.environ, {"CCACHE_DIR": str(self.folder / "cache")})
        cache.start()
        self.addCleanup(cache.stop)
        self.write("A.h", "#pragma once\ninline int A() { return 1; }\n")
        self.write("A.cpp", '#include "A.h"\n')
        self.write("B.cpp", '#include "A.h"\nint B() { return A(); }\n')
        self.set_options("-Wall -Wextra")
        # A clang that counts the units whose syntax it checks.
        self.clang = self.folder / "clang"
        self.clang.write_text(f'#!/bin/sh\ncase "$*" in *-fsyntax-only*) echo >>{self.folder}/readings;; esac\n'
                              f'exec {CLANG} "$@"\n')
        self.clang.chmod(0o755)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        # ccache does not trust a file that is as new as its own reading of it.
        os.utime(self.folder / name, (1, 1))

    def set_options(self, options):
        self.write("compile_commands.json", json.dumps([
            {"directory": str(self.folder), "file": str(self.folder / name),
             "command": f"c++ -I {self.folder} {options} -std=c++20 -o {name}.o -c {self.folder / name}"}
            for name in ("A.cpp", "B.cpp")]))

    def check(self):
        """The units at fault, and how many readings there were."""
        readings = self.folder / "readings"
        readings.write_text("")
        failures, _ = check_clang.check(str(self.clang), self.folder, [], 1)
        return [pathlib.Path(unit).name for unit, _ in failures], len(readings.read_text())

    def test_what_is_good_is_not_read_again(self):
        self.assertEqual(self.check(), ([], 1))
        self.assertEqual(self.check(), ([], 0))

    def test_what_is_at_fault_is_said_again(self):
        self.write("B.cpp", "int B(int unused) { return 1; }\n")
        first, _ = self.check()
        second, readings = self.check()
        self.assertEqual((first, second, readings), (["B.cpp"], ["B.cpp"], 0))

    def test_a_clang_that_fails_is_a_fault(self):
        self.clang.write_text(f'#!/bin/sh\ncase "$*" in *-fsyntax-only*) exit 139;; esac\nexec {CLANG} "$@"\n')
        self.assertEqual(self.check()[0], ["A.cpp", "B.cpp"])

    def test_a_fault_that_comes_into_a_header_is_found(self):
        self.check()
        self.write("A.h", "#pragma once\ninline int A(int unused = 1) { return 1; }\n")
        self.assertEqual(self.check()[0], ["A.cpp", "B.cpp"])

    def test_a_fault_that_comes_into_a_unit_is_found(self):
        self.check()
        self.write("B.cpp", "int B(int unused) { return 1; }\n")
        self.assertEqual(self.check()[0], ["B.cpp"])

    def test_what_was_good_by_fewer_warnings_is_read_again(self):
        self.write("B.cpp", "int B(int same) { { int same = 1; (void)same; } return same; }\n")
        self.assertEqual(self.check()[0], [])
        self.set_options("-Wall -Wextra -Wshadow")
        self.assertEqual(self.check()[0], ["B.cpp"])


if __name__ == "__main__":
    if not shutil.which(sys.argv[1]):
        print(f"skipped: no {sys.argv[1]} here")
        sys.exit(check_clang.SKIPPED)
    CLANG = sys.argv.pop(1)
    unittest.main()
