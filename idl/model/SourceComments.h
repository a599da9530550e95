// The comments of an IDL file on its definitions, which idlc drops.
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

    // The comment on the declaration in that line, counted from 1: first the comment lines right above it,
    // with lines of annotations allowed in between, then the comment behind it. A comment behind code
    // continues in the lines below it that begin a comment in the same column, or end its block. Without
    // comment markers, and fit to follow `//` in C++.
    std::vector<std::string> About(std::uint32_t line) const;

private:
    struct Line
    {
        std::string Code;
        std::string Comment;
        bool HasComment = false;
        std::size_t Column = 0;  // where the comment begins
        bool Continues = false;  // the comment continues one behind the code of a line above
    };
    void Read(const std::string &text);
    void BeginLine();
    void BeginComment(std::size_t column);
    // True if a comment of the last line would continue one behind code.
    bool FollowsCode() const;
    std::size_t ReadCode(const std::string &text, std::size_t at);
    const Line *At(std::size_t line) const
    {
        return line >= 1 && line <= _lines.size() ? &_lines[line - 1] : nullptr;
    }

    std::vector<Line> _lines;
    bool _inBlock = false;
};

}  // namespace RabitIdl
