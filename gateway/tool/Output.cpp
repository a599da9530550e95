#include "Output.h"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "CommonOptions.h"
#include "JsonText.h"
#include "SafeText.h"

namespace Rabit::Tool::Output
{
namespace
{

int firstError = 0;  // of a write to standard output, as errno

bool Noted(bool isWritten)
{
    firstError = isWritten || firstError != 0 ? firstError : errno;
    return isWritten;
}

}  // namespace

bool Line(std::string_view line)
{
    return Noted(std::fwrite(line.data(), 1, line.size(), stdout) == line.size() &&
                 std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0);
}

int Ended(int code)
{
    Noted(std::fflush(stdout) == 0);
    // Some file systems report a full disk only here. If standard output was closed before, nobody wants it.
    Noted(::close(STDOUT_FILENO) == 0 || errno == EBADF);
    if (firstError == 0 || firstError == EPIPE)
    {
        return code;
    }
    Talk("cannot write: " + std::generic_category().message(firstError));
    return code == Good ? ProblemFound : code;
}

bool Lines(const std::vector<std::string> &lines)
{
    return std::all_of(lines.begin(), lines.end(), Line);
}

bool Object(const nlohmann::ordered_json &object)
{
    return Line(JsonText(object));
}

bool ObjectOrLine(bool json, const nlohmann::ordered_json &object, std::string_view line)
{
    return json ? Object(object) : Line(line);
}

void Talk(std::string_view text)
{
    std::fprintf(stderr, "rabit: %s\n", SafeText(text).c_str());
}

void Talk(const std::vector<std::string> &texts)
{
    for (const std::string &text : texts)
    {
        Talk(text);
    }
}

void BeginScreen()
{
    if (::isatty(STDOUT_FILENO) != 0)
    {
        std::fputs("\x1b[H\x1b[2J", stdout);
    }
}

}  // namespace Rabit::Tool::Output
