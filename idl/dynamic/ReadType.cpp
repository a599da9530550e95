#include "dynamic/ReadType.h"

#include "dynamic/IdlParser.h"
#include "dynamic/ShapeBuilder.h"
#include "dynamic/TextGuard.h"
#include "model/ModelReader.h"

#include <algorithm>
#include <mutex>

namespace Rabit::Dynamic
{
namespace
{

struct FreeState
{
    void operator()(const void *state) const { RabitFreeIdl(state); }
};

// Makes the reason one line that is safe for any terminal: names in it come from the text.
std::string Line(std::string_view reason)
{
    std::string line(reason.substr(0, 300));
    std::replace_if(
        line.begin(), line.end(), [](char letter) { return letter < 0x20 || letter == 0x7f; }, '?');
    return line;
}

}  // namespace

std::unique_ptr<const Shapes> ReadType(std::string_view idlText, const std::string &name, std::string &reason)
{
    reason = WhyNotParsed(idlText);
    if (!reason.empty())
    {
        return nullptr;
    }
    // The parser does not promise to be thread-safe.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const std::string text(idlText);  // ends in zero
    char parserReason[512];
    const std::unique_ptr<const void, FreeState> state(
        RabitParseIdl(text.c_str(), parserReason, sizeof parserReason));
    if (!state)
    {
        reason = parserReason[0] != '\0' ? Line(parserReason) : "not IDL";
        return nullptr;
    }
    try
    {
        RabitIdl::Refusals refusals;
        const RabitIdl::Model model = RabitIdl::ModelReader(state.get(), refusals).Read();
        if (!refusals.Empty())
        {
            // The line is `:12: reason`, as there is no file.
            reason = Line("line " + refusals.First().substr(1));
            return nullptr;
        }
        return ShapeBuilder(model).Build(name);
    }
    catch (const Refused &refused)
    {
        reason = Line(refused.what());
        return nullptr;
    }
}

}  // namespace Rabit::Dynamic
