#pragma once

#include <map>
#include <string>

namespace Rabit
{

// How a message is shown in a panel of a viewer that has schemas of its own: `rabit foxglove` converts each
// value to that schema.
struct PanelRule
{
    // Foxglove's schemas of the same names, for its map, pictures and log.
    enum class Panel
    {
        LocationFix,
        CompressedImage,
        Log
    };

    std::string Message;  // of whichever node
    Panel Schema = Panel::LocationFix;
    // Members of the schema, and where their values are in the message, as `a.b`; `=text` is that text. The
    // time is added, and the node as frame_id unless Fields names that.
    std::map<std::string, std::string> Fields{};
    int Line = 0;
};

}  // namespace Rabit
