#include "TerminalScreen.h"

#include <algorithm>

namespace Ground
{
namespace
{
constexpr const char *EraseLine = "\x1b[K";
constexpr const char *EraseBelow = "\x1b[J";
constexpr const char *EraseScreen = "\x1b[2J\x1b[H";
constexpr const char *Plain = "\x1b[0m";

const char *StyleOf(Emphasis shown)
{
    switch (shown)
    {
        case Emphasis::None:
            return "";
        case Emphasis::Heading:
            return "\x1b[1m";  // bold
        case Emphasis::Warning:
            return "\x1b[33m";  // yellow
        case Emphasis::Alarm:
            return "\x1b[1;31m";  // bold red
    }
    return "";
}
}  // namespace

std::string TerminalScreen::Redraw(const std::vector<TableLine> &lines, const Size &size,
                                   const std::vector<std::string> &above)
{
    std::string text;
    if (_drawn > 0 && size != _size)
        text = EraseScreen;  // the terminal has wrapped the old lines again: their positions are unknown
    else if (_drawn > 0)
        text = "\x1b[" + std::to_string(_drawn) + "A\r";

    for (const std::string &line : above)
        text += EraseBelow + line + "\n";
    // Each line is erased before it is written: behind a line as wide as the terminal, erasing would take its
    // last character. The cursor rests on the line below the last one.
    const std::size_t room = std::max<std::size_t>(size.Rows, 3) - 1;
    const std::size_t shown = lines.size() <= room ? lines.size() : room - 1;
    for (std::size_t i = 0; i < shown; ++i)
    {
        const std::string style = StyleOf(lines[i].Shown);
        text +=
            EraseLine + style + lines[i].Text.substr(0, size.Columns) + (style.empty() ? "" : Plain) + "\n";
    }
    if (shown < lines.size())
    {
        const std::string more = "... " + std::to_string(lines.size() - shown) + " more";
        text += EraseLine + more.substr(0, size.Columns) + "\n";
    }
    _drawn = std::min(lines.size(), room);
    _size = size;
    return text + EraseBelow;
}

}  // namespace Ground
