#pragma once

#include <map>
#include <string>

namespace Rabit
{

// How messages are shown in a viewer's panel that knows some schemas of its own: `rabit foxglove` makes such
// a message of each value.
struct PanelRule
{
    // Schemas of Foxglove, of the same names: for its map, its pictures and its log.
    enum class Panel
    {
        LocationFix,
        CompressedImage,
        Log
    };

    std::string Message;  // of whichever node
    Panel Schema = Panel::LocationFix;
    // Members of the schema, and where their values are in the message, as `a.b`; `=text` is that text. Time
    // and, unless it is named, frame_id (the node) are known without.
    std::map<std::string, std::string> Fields{};
    int Line = 0;
};

}  // namespace Rabit
