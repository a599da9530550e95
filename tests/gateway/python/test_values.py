import copy
import pickle

import numpy
import pytest

import rabit
from conftest import ROOT


def write(folder, text, name="test.idl"):
    path = folder / name
    path.write_text(text)
    return path


EVERYTHING = """
#ifndef EVERYTHING
#define EVERYTHING
#include "shared.idl"
module PyEverything {
const long MOST = 3;
enum Color { RED, GREEN, BLUE };
@bit_bound(8) bitmask Flags { LOW, HIGH };
@final union Choice switch (long) { case 1: long number; case 2: string text; };
@nested @final struct Point { double x; @default(2.5) double y; };
@final
struct All {
    boolean flag;              // a flag
    char letter;
    octet byte;
    short small;
    unsigned long long large;
    float single;
    @default("none") string<8> name;
    sequence<double, MOST> numbers;
    sequence<octet> bytes;
    float matrix[2][3];
    sequence<Point> points;
    Color color;
    Flags flags;
    Choice choice;
    PyShared::Id id;
    sequence<string> texts;
    sequence<boolean> bits;
    boolean from;
};
};
#endif
"""


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    folder = tmp_path_factory.mktemp("idl")
    write(folder, "module PyShared { @nested @final struct Id { unsigned long number; }; };", "shared.idl")
    return rabit.load_idl(write(folder, EVERYTHING))


def test_members_have_the_defaults_of_the_idl_file(everything):
    value = everything.PyEverything.All()
    assert (value.flag, value.letter, value.byte, value.single, value.name) == (False, "\0", 0, 0.0, "none")
    assert value.color is everything.PyEverything.Color.RED
    assert value.numbers.dtype == numpy.float64 and len(value.numbers) == 0
    assert value.matrix.shape == (2, 3)
    assert everything.PyEverything.Point().y == 2.5
    assert everything.PyEverything.MOST == 3
    assert value.from_ is False


def test_every_kind_of_member_survives_encoding(everything):
    py = everything.PyEverything
    value = py.All(
        flag=True, letter="é", byte=255, small=-5, large=2**64 - 1, single=0.5, name="abc", numbers=[1, 2.5],
        bytes=b"\x01\x02", matrix=[[1, 2, 3], [4, 5, 6]], points=[py.Point(1, 2), {"x": 3.0}], color="BLUE",
        flags=py.Flags.HIGH, choice=py.Choice(text="hi"), id={"number": 7}, texts=["a", ""], bits=[True, False],
    )
    again = rabit.from_bytes(py.All, rabit.to_bytes(value))
    assert again == value
    assert again.points[1] == py.Point(3.0, 2.5)
    assert again.choice.text == "hi" and again.choice.case == "text"
    assert again.numbers.tolist() == [1.0, 2.5] and again.bytes.tolist() == [1, 2]
    assert again.color is py.Color.BLUE and again.flags == py.Flags.HIGH
    assert copy.deepcopy(value) == value and copy.copy(value) == value
    assert pickle.loads(pickle.dumps(value)) == value
    assert rabit.from_json(py.All, rabit.to_json(value)) == value
    assert rabit.replace(value, byte=1) != value


@pytest.mark.parametrize("name", ["numpy.bool", "numpy.bool_"])
def test_a_boolean_of_each_numpy_is_a_boolean(everything, name):
    """numpy 2 has another name for its type than numpy 1; only one of the two is installed."""
    true = type(name, (), {"__bool__": lambda self: True})()
    value = everything.PyEverything.All(flag=true, bits=[true])
    again = rabit.from_bytes(everything.PyEverything.All, rabit.to_bytes(value))
    assert again.flag is True and list(again.bits) == [True]


def test_numbers_of_a_sample_lie_in_one_copy_of_it(everything):
    py = everything.PyEverything
    again = rabit.from_bytes(py.All, rabit.to_bytes(py.All(numbers=[1, 2, 3], bytes=bytes(1000))))
    assert not again.numbers.flags.owndata and again.numbers.base is again.bytes.base
    # As in the sample: behind three numbers of 8 bytes is the length of `bytes`, of 4.
    assert again.bytes.ctypes.data - again.numbers.ctypes.data == 3 * 8 + 4


@pytest.mark.parametrize(
    "member, value, error, text",
    [
        ("small", "high", TypeError, "PyEverything::All.small: expected a whole number, not 'high'"),
        ("small", 40000, ValueError, "PyEverything::All.small: expected a whole number from -32768 to 32767, not 40000"),
        ("byte", -1, ValueError, "expected a whole number from 0 to 255, not -1"),
        ("single", "x", TypeError, "PyEverything::All.single: expected a number, not 'x'"),
        ("single", 1e300, ValueError, "expected a number that a float can hold"),
        ("name", 5, TypeError, "PyEverything::All.name: expected a str, not 5"),
        ("name", "too long a name", ValueError, "expected at most 8 bytes, not 15"),
        ("numbers", [1, 2, 3, 4], ValueError, "PyEverything::All.numbers: expected at most 3 elements, not 4"),
        ("numbers", [1, "x"], TypeError, "PyEverything::All.numbers[1]: expected a number, not 'x'"),
        ("matrix", [[1, 2, 3]], ValueError, "PyEverything::All.matrix: expected 2 elements, not 1"),
        ("color", "BLU", ValueError, "no value of PyEverything::Color is named `BLU`; did you mean `BLUE`?"),
        ("color", 17, TypeError, "expected a value of PyEverything::Color, not 17"),
        ("points", [{"z": 1}], TypeError, "PyEverything::All.points[0] has no member `z`"),
        ("id", 5, TypeError, "PyEverything::All.id: expected a PyShared::Id, not 5"),
        ("flag", 1, TypeError, "PyEverything::All.flag: expected True or False, not 1"),
    ],
)
def test_a_wrong_value_is_refused_with_the_member_and_what_it_wants(everything, member, value, error, text):
    made = everything.PyEverything.All()
    with pytest.raises(error) as raised:
        setattr(made, member, value)
    assert text in str(raised.value)
    with pytest.raises(error):
        everything.PyEverything.All(**{member: value})


def test_a_wrong_name_is_refused_with_the_nearest(everything, idl):
    with pytest.raises(TypeError, match="Uav::Goto has no member `altitud_m`; did you mean `altitude_m`"):
        idl.Uav.Goto(altitud_m=1)
    with pytest.raises(AttributeError, match="did you mean `altitude_m`"):
        idl.Uav.Goto().altitud_m = 1
    with pytest.raises(AttributeError, match="did you mean `altitude_m`"):
        idl.Uav.Goto().altitud_m
    with pytest.raises(AttributeError, match="did you mean `Pose`"):
        idl.Uav.Pse
    with pytest.raises(KeyError, match="did you mean `Uav::Pose`"):
        rabit.message_class("Uav::Poze")


def test_what_is_changed_in_a_list_is_checked_when_the_message_is_used(everything):
    value = everything.PyEverything.All()
    value.texts.append(5)
    with pytest.raises(TypeError, match=r"PyEverything::All.texts\[0\]: expected a str, not 5"):
        rabit.to_bytes(value)


def test_a_message_has_a_text_and_a_docstring(idl, everything):
    assert repr(idl.Uav.Geofence(1, 2, radius_m=3)) == (
        "Uav.Geofence(latitude_deg=1.0, longitude_deg=2.0, radius_m=3.0)")
    assert "a flag" in everything.PyEverything.All.__doc__


def test_a_damaged_sample_is_refused(everything):
    sample = rabit.to_bytes(everything.PyEverything.All())
    for end in range(len(sample) - 4):
        with pytest.raises(ValueError, match="not a sample of PyEverything::All"):
            rabit.from_bytes(everything.PyEverything.All, sample[:end])


@pytest.mark.parametrize(
    "text, reason",
    [
        ("module M { struct A { long x } };", r"test.idl:1: "),
        ("module M { @final struct A { wstring x; }; };", r"test.idl:1: "),
        ("\n#if 1\n#endif\n", r"test.idl:2: `#if 1` is not supported here"),
        ('#include "none.idl"', r"test.idl:1: there is no file `none.idl`"),
        ("module Uav { @final struct Pose { long x; }; };", "another definition of Uav::Pose is in use"),
        ("}}}} module", r"test.idl:1: "),
    ],
)
def test_a_wrong_idl_file_is_refused_with_its_line(tmp_path, idl, text, reason):
    with pytest.raises(ValueError, match=reason):
        rabit.load_idl(write(tmp_path, text))


def test_the_same_file_gives_the_same_classes(idl):
    assert rabit.load_idl(ROOT / "idl/messages/uav.idl").Uav.Pose is idl.Uav.Pose
    assert rabit.message_class("Uav::Pose") is idl.Uav.Pose
    assert type(idl.Uav.Detections().pose) is idl.Uav.Pose


def test_a_list_is_written_as_it_was_whatever_its_elements_do(everything):
    class Clears:
        def __float__(self):
            numbers.clear()
            points.clear()
            return 1.0

    numbers, points = [Clears(), 2.0, 3.0], []
    assert list(everything.PyEverything.All(numbers=numbers).numbers) == [1, 2, 3]
    numbers, points = [], [{"x": Clears()}, {"x": 2.0}]
    assert [point.x for point in everything.PyEverything.All(points=points).points] == [1, 2]
