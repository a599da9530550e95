// What the comments of an IDL file say about its definitions: idlc drops them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace RabitIdl
{

class SourceComments
{
public:
    // No comments if the file cannot be read.
    explicit SourceComments(const std::string &path);

    // The comment on what is declared in that line, counted from 1: the lines of comment right above it,
    // where lines of annotations may be in between, then the one behind it. Without the signs of comments,
    // and fit to stand behind `//` in C++.
    std::vector<std::string> About(std::uint32_t line) const;

private:
    struct Line
    {
        std::string Code;
        std::string Comment;
        bool HasComment = false;
    };
    void Read(const std::string &text);
    std::size_t ReadCode(const std::string &text, std::size_t at);
    const Line *At(std::size_t line) const
    {
        return line >= 1 && line <= _lines.size() ? &_lines[line - 1] : nullptr;
    }

    std::vector<Line> _lines;
    bool _inBlock = false;
};

}  // namespace RabitIdl
