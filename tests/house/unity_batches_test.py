#!/usr/bin/env python3
"""Checks which sources docker/unity/batches.py puts together."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docker/unity"))
import batches  # noqa: E402


class Defined(unittest.TestCase):
    def defined(self, text):
        return batches.Source(text).names

    def test_functions_values_and_types_of_namespaces(self):
        text = """
            namespace Rabit { namespace {
            constexpr std::chrono::seconds Longest{3};
            const std::map<int, std::function<void(int)>> Table = {{1, F}};
            std::array<int, 3> Counts;
            int Numbers[3];
            class Widget final : public Base { void Inner(); };
            struct [[nodiscard]] Pair { int a; };
            enum Colour : int { Red = 1, Green };
            enum class Kind { Hidden };
            using Name = std::string;
            template <typename T> T Twice(const T &value) { const int local = 1; return local * value; }
            [[maybe_unused]] static bool IsOdd(int n) { return n % 2 == 1; }
            }  // namespace
            void Free(Widget &widget) {}
            }"""
        self.assertEqual(self.defined(text), {"Longest", "Table", "Counts", "Numbers", "Widget", "Pair", "Red", "Green",
                                              "Colour", "Kind", "Name", "Twice", "IsOdd", "Free"})

    def test_members_announcements_and_what_is_used_are_not_defined_here(self):
        text = """
            using namespace std;
            using Rabit::Clock;
            namespace Rabit {
            class Later;
            void PeerTable::Add(int node) { for (int i = 0; i < 3; ++i) { Beat(i); } }
            PeerTable::PeerTable() : _clock{1}, _first(2) {}
            int PeerTable::count = 0;
            }"""
        self.assertEqual(self.defined(text), set())

    def test_comments_literals_and_directives_define_nothing(self):
        text = ('// int A;\n/* int B; */\n#include "int C;"\n#define TWO_LINES int D; \\\n  int E;\n'
                'const char *Text = R"x(" int F; )x" "\\" int G;";\nconst int Big = 1\'000\'000;\nconst char Quote = \'"\';\n')
        self.assertEqual(self.defined(text), {"Text", "Big", "Quote"})

    def test_a_test_is_defined_by_its_two_names(self):
        self.assertEqual(self.defined("TEST(Suite, Name) { int x; }\nTEST_F(Fixture, Other) {}\nTEST_P(Many, Each) {}\n"
                                      "INSTANTIATE_TEST_SUITE_P(All, Many, ::testing::Values(1));\n"),
                         {"Suite_Name_Test", "Fixture_Other_Test", "Many_Each_Test"})


class Batches(unittest.TestCase):
    def batches(self, most, **texts):
        return batches.batches({name: batches.Source(text) for name, text in texts.items()}, most)

    def test_hold_no_more_than_is_said(self):
        self.assertEqual(self.batches(2, a="", b="", c=""), [["a", "b"], ["c"]])

    def test_are_of_one_size_so_that_no_source_is_left_over(self):
        self.assertEqual([batches.size(count, 12) for count in (1, 12, 13, 17, 18, 25, 55, 100)], [1, 12, 13, 17, 9, 13, 11, 13])

    def test_have_each_name_once(self):
        same = "namespace { int Same() { return 1; } }"
        self.assertEqual(self.batches(9, a=same, b=same, c="int Other() { return 1; }"), [["a", "c"], ["b"]])

    def test_may_have_one_alias_in_each_file(self):
        for alias in ("using", "namespace"):
            self.assertEqual(self.batches(9, a=f"namespace {{ {alias} Short = A::Long; }}",
                                          b=f"namespace {{ {alias} Short = A::Long; }}",
                                          c=f"namespace {{ {alias} Short = B::Long; }}",
                                          d="namespace { struct Short { int x; }; }"), [["a", "b"], ["c"], ["d"]])

    def test_have_each_template_of_an_alias_once(self):
        text = "namespace { template <typename T> using Many = std::vector<T>; }"
        self.assertEqual(self.batches(9, a=text, b=text), [["a"], ["b"]])

    def test_may_have_one_name_in_different_namespaces(self):
        def named(name):
            return f"namespace Rabit {{ namespace {name} {{ namespace {{ struct Same {{ int x; }}; }} }} void Add{name}() {{\n    using namespace {name};\n}} }}"
        self.assertEqual(self.batches(9, a=named("A"), b=named("B"), c=named("A")), [["a", "b"], ["c"]])

    def test_keep_macros_from_those_that_use_the_name(self):
        self.assertEqual(self.batches(9, a="#define CHECK(x) x\n", b="int F() { return CHECK(1); }\n"), [["a"], ["b"]])

    def test_keep_apart_who_has_the_names_of_different_namespaces(self):
        self.assertEqual(self.batches(9, a="using namespace A;\n", b="namespace B { using namespace B::C; }\n", c="",
                                      d="using namespace A;\n"), [["a", "c", "d"], ["b"]])

    def test_may_have_literals_in_some_files_alone(self):
        self.assertEqual(self.batches(9, a="using namespace A;\nusing namespace std::chrono_literals;\n", b="using namespace A;\n",
                                      c="using namespace std::literals;\n"), [["a", "b", "c"]])

    def test_keep_a_name_that_is_brought_in_from_another_of_its_kind(self):
        self.assertEqual(self.batches(9, a="using A::Same;\n", b="using ::A::Same;\n", c="using C::Same;\n",
                                      d="namespace { struct Same { int x; }; }\n"), [["a", "b"], ["c"], ["d"]])

    def test_are_told_to_cmake_unless_several_targets_share_the_source(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name in ("A.cpp", "B.cpp", "Shared.cpp"):
                (folder / name).write_text("")
            units = folder / "units.txt"
            units.write_text("".join(f"{target}\t{folder}\t{name}\n" for target, name in (
                ("one", "A.cpp"), ("one", "B.cpp"), ("one", "Shared.cpp"), ("two", "Shared.cpp"),
                ("three", f"{folder}/generated/a.idl.cpp"), ("three", f"{folder}/generated/b.idl.cpp"))))
            said = subprocess.run([sys.executable, str(ROOT / "docker/unity/batches.py"), "9", str(units)],
                                  capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.splitlines(), [
            f'set_property(SOURCE "{folder}/A.cpp" "{folder}/B.cpp" TARGET_DIRECTORY one PROPERTY UNITY_GROUP 0)',
            "set_target_properties(one PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)",
            f'set_property(SOURCE "{folder}/generated/a.idl.cpp" "{folder}/generated/b.idl.cpp" TARGET_DIRECTORY three '
            "PROPERTY UNITY_GROUP 0)",
            "set_target_properties(three PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)"])


if __name__ == "__main__":
    unittest.main()
