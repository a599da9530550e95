#include "model/SourceComments.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace RabitIdl
{
namespace
{

std::string Trimmed(const std::string &text, const char *letters)
{
    const std::size_t first = text.find_first_not_of(letters);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(letters) - first + 1);
}

// Removes documentation markers, and a backslash at the end, which would continue the comment into the next
// line of C++.
std::string Cleaned(const std::string &comment)
{
    std::string text = Trimmed(comment, " \t\r");
    text.erase(0, std::min(text.find_first_not_of("/*!<"), text.size()));
    while (!text.empty() && std::string(" \t\r\\*").find(text.back()) != std::string::npos)
    {
        text.pop_back();
    }
    return Trimmed(text, " \t");
}

bool IsBlank(const std::string &text)
{
    return text.find_first_not_of(" \t\r") == std::string::npos;
}

// True for a line of annotations alone: no declaration begins or ends there.
bool IsAnnotation(const std::string &code)
{
    const std::string text = Trimmed(code, " \t\r");
    return !text.empty() && text.front() == '@' && std::string(";,{").find(text.back()) == std::string::npos;
}

}  // namespace

SourceComments::SourceComments(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    Read(std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

void SourceComments::Read(const std::string &text)
{
    _lines.emplace_back();
    std::size_t begin = 0;  // of the line
    for (std::size_t at = 0; at < text.size();)
    {
        Line &line = _lines.back();
        if (text[at] == '\n')
        {
            BeginLine();
            begin = ++at;
        }
        else if (_inBlock)
        {
            _inBlock = text.compare(at, 2, "*/") != 0;
            line.Comment += _inBlock ? text.substr(at, 1) : "";
            at += _inBlock ? 1 : 2;
        }
        else if (text.compare(at, 2, "//") == 0)
        {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            BeginComment(at - begin);
            line.Comment += text.substr(at, end - at);
            at = end;
        }
        else if (text.compare(at, 2, "/*") == 0)
        {
            BeginComment(at - begin);
            _inBlock = true;
            at += 2;
        }
        else
        {
            at = ReadCode(text, at);
        }
    }
}

void SourceComments::BeginLine()
{
    _lines.emplace_back();
    Line &line = _lines.back();
    line.HasComment = _inBlock;
    line.Continues = _inBlock && FollowsCode();
    line.Column = _inBlock ? _lines[_lines.size() - 2].Column : 0;
}

void SourceComments::BeginComment(std::size_t column)
{
    Line &line = _lines.back();
    if (line.HasComment)
    {
        return;
    }
    line.HasComment = true;
    line.Column = column;
    line.Continues = IsBlank(line.Code) && FollowsCode() && _lines[_lines.size() - 2].Column == column;
}

bool SourceComments::FollowsCode() const
{
    const Line *above = At(_lines.size() - 1);
    return above != nullptr && above->HasComment && (above->Continues || !IsBlank(above->Code));
}

// Skips one letter, or a whole string or character literal, which contains no comment.
std::size_t SourceComments::ReadCode(const std::string &text, std::size_t at)
{
    const char quote = text[at];
    std::size_t end = at + 1;
    if (quote == '"' || quote == '\'')
    {
        while (end < text.size() && text[end] != quote && text[end] != '\n')
        {
            end += text[end] == '\\' ? 2 : 1;
        }
        end = std::min(end + (end < text.size() && text[end] == quote ? 1 : 0), text.size());
    }
    _lines.back().Code += text.substr(at, end - at);
    return end;
}

std::vector<std::string> SourceComments::About(std::uint32_t line) const
{
    // The preprocessor moves the code before a block comment into the last line of the block.
    while (At(line) != nullptr && At(line)->Continues && IsBlank(At(line)->Code))
    {
        --line;
    }
    std::vector<std::string> about;
    for (std::size_t above = std::size_t{line} - 1; At(above) != nullptr; --above)
    {
        const Line &candidate = *At(above);
        if (IsBlank(candidate.Code) && candidate.HasComment && !candidate.Continues)
        {
            about.insert(about.begin(), Cleaned(candidate.Comment));
        }
        else if (!about.empty() || !IsAnnotation(candidate.Code))
        {
            break;
        }
    }
    const Line *own = At(line);
    if (own != nullptr && own->HasComment && !own->Continues && !IsBlank(own->Code))
    {
        about.push_back(Cleaned(own->Comment));
        for (std::size_t below = std::size_t{line} + 1; At(below) != nullptr && At(below)->Continues; ++below)
        {
            about.push_back(Cleaned(At(below)->Comment));
        }
    }
    const auto isEmpty = [](const std::string &text) { return text.empty(); };
    about.erase(about.begin(), std::find_if_not(about.begin(), about.end(), isEmpty));
    while (!about.empty() && about.back().empty())
    {
        about.pop_back();
    }
    return about;
}

}  // namespace RabitIdl
