// The contents of a `.msg` file of ROS 2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace RabitIdl
{

struct MsgType
{
    enum class Kind
    {
        Bool,
        Integer,
        Float,
        String,
        Message
    };
    enum class Array
    {
        None,
        Fixed,
        Bounded,
        Unbounded
    };
    Kind What = Kind::Bool;
    std::string Idl;          // of a primitive or string, as IDL calls it
    std::string Package;      // of a message
    std::string Name;         // likewise
    std::uint32_t Bound = 0;  // of a string; 0: none
    Array Several = Array::None;
    std::uint32_t Length = 0;  // of an array, or the bound of one
    // Of an integer.
    std::int64_t Least = 0;
    std::uint64_t Most = 0;
};

// A field, or a constant.
struct MsgEntry
{
    MsgType Type;
    std::string Name;
    std::string Value;  // in IDL: of a constant, or a field's default; empty: it has none
    std::vector<std::string> Comment;
};

struct MsgFile
{
    std::string Package;
    std::string Name;
    std::vector<std::string> Comment;  // at its beginning, before an empty line
    std::vector<MsgEntry> Constants;
    std::vector<MsgEntry> Fields;
};

}  // namespace RabitIdl
