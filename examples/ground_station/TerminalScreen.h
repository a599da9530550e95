#pragma once

#include "FleetTable.h"

#include <cstddef>
#include <string>
#include <vector>

namespace Ground
{

// Draws lines over the lines drawn before, by ECMA-48 control sequences that every Linux terminal knows. It
// only makes the text; the caller writes it, and nothing else in between.
class TerminalScreen
{
public:
    struct Size
    {
        std::size_t Columns = 80;
        std::size_t Rows = 24;

        bool operator==(const Size &) const = default;
    };

    // The text that makes the terminal show these lines in place of the last ones. Lines too wide are cut,
    // because a wrapped line would spoil the next redraw. If there are too many lines, the last one tells
    // how many are missing. `above` is written once, above them, and scrolls away like any other output.
    std::string Redraw(const std::vector<TableLine> &lines, const Size &size,
                       const std::vector<std::string> &above = {});

private:
    std::size_t _drawn = 0;
    Size _size;
};

}  // namespace Ground
