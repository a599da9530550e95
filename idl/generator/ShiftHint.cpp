#include "ShiftHint.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace RabitIdl
{
namespace
{

// The end of a comment, string or character that begins at `at`; otherwise `at`.
std::size_t EndOfWhatIsNoCode(const std::string &text, std::size_t at)
{
    std::size_t end = at;
    if (text.compare(at, 2, "//") == 0)
    {
        end = text.find('\n', at);
    }
    else if (text.compare(at, 2, "/*") == 0)
    {
        end = text.find("*/", at + 2);
        end = end == std::string::npos ? end : end + 2;
    }
    else if (text[at] == '"' || text[at] == '\'')
    {
        for (end = at + 1; end < text.size() && text[end] != text[at] && text[end] != '\n'; ++end)
        {
            end += text[end] == '\\' ? 1 : 0;
        }
        ++end;
    }
    return std::min(end, text.size());
}

bool EndsInSequence(const std::string &code)
{
    const std::string word = "sequence";
    std::size_t end = code.size();
    while (end > 0 && std::isspace(static_cast<unsigned char>(code[end - 1])) != 0)
    {
        --end;
    }
    return end >= word.size() && code.compare(end - word.size(), word.size(), word) == 0;
}

// The files that idlc was called with.
std::vector<std::string> IdlArguments()
{
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::vector<std::string> paths;
    for (std::string argument; std::getline(file, argument, '\0');)
    {
        if (argument.size() > 4 && argument.compare(argument.size() - 4, 4, ".idl") == 0)
        {
            paths.push_back(argument);
        }
    }
    return paths;
}

// The generator is not called for a file that does not parse, so this runs when idlc loads it.
__attribute__((constructor)) void PrintShiftHints()
{
    for (const std::string &path : IdlArguments())
    {
        std::ifstream file(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        for (const std::string &hint : ShiftHints(text))
        {
            std::fprintf(stderr, "%s:%s\n", path.c_str(), hint.c_str());
        }
    }
}

}  // namespace

std::vector<std::string> ShiftHints(const std::string &text)
{
    std::vector<std::string> hints;
    std::string code;  // of the declaration so far
    int depth = 0;     // of open sequences
    std::size_t line = 1;
    for (std::size_t at = 0; at < text.size();)
    {
        const std::size_t end = EndOfWhatIsNoCode(text, at);
        if (end > at)
        {
            line +=
                static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                    text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            at = end;
            continue;
        }
        const char letter = text[at];
        if (letter == '<' && (depth > 0 || EndsInSequence(code)))
        {
            ++depth;
        }
        else if (letter == '>' && depth > 0)
        {
            if (depth > 1 && at + 1 < text.size() && text[at + 1] == '>')
            {
                hints.push_back(std::to_string(line) +
                                ": write \"> >\" with a blank between the ends of two sequences: idlc takes "
                                "\">>\" for a shift");
                depth = 0;  // one hint for a declaration
            }
            depth = std::max(depth - 1, 0);
        }
        line += letter == '\n' ? 1 : 0;
        code += letter;
        if (letter == ';')
        {
            code.clear();
            depth = 0;
        }
        ++at;
    }
    return hints;
}

}  // namespace RabitIdl
