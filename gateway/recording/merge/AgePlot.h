#pragma once

#include <string>
#include <vector>

#include "recording/merge/AgeHistory.h"

namespace Rabit::Merge
{

// Ages over time as a picture (SVG 1.1, nothing else needed): a panel for each pair of nodes, one below the
// other, with a line for each message. Time goes to the right, the same in all panels; age goes up, by
// decades, the same in all panels. Each column of the picture shows its range of ages, and the oldest as a
// line.
struct AgePlot
{
    // Columns that each history must have, so that it is as wide as it is drawn.
    static constexpr std::size_t Columns = 880;

    struct Line
    {
        std::string Message;
        const AgeHistory *Ages = nullptr;
    };
    struct Panel
    {
        std::string Title;
        std::vector<Line> Lines;
    };

    std::string Title;
    std::string Note;  // below the title
    Moment Begin = 0;
    Moment End = 0;
    std::vector<Panel> Panels;

    std::string ToSvg() const;
};

}  // namespace Rabit::Merge
