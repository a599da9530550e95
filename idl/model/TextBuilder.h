// Text that is written line by line, for the emitters.
#pragma once

#include <string>
#include <vector>

namespace RabitIdl
{

class TextBuilder
{
public:
    // Appends a line at the current depth; an empty line gets no blanks.
    void Line(const std::string &text = "")
    {
        if (!text.empty())
        {
            _text.append(4 * _depth, ' ');
        }
        _text += text + "\n";
    }
    // Lines of comment.
    void Comment(const std::vector<std::string> &lines)
    {
        for (const std::string &line : lines)
        {
            Line(line.empty() ? "//" : "// " + line);
        }
    }
    void Open()
    {
        Line("{");
        ++_depth;
    }
    void Close(const std::string &after = "")
    {
        --_depth;
        Line("}" + after);
    }
    // A line one step to the left, for labels.
    void Label(const std::string &text)
    {
        --_depth;
        Line(text);
        ++_depth;
    }
    // Changes the depth without braces.
    void Indent() { ++_depth; }
    void Outdent() { --_depth; }
    const std::string &Text() const { return _text; }

private:
    std::string _text;
    std::size_t _depth = 0;
};

}  // namespace RabitIdl
