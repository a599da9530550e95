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
        line.begin(), line.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
    return line;
}

}  // namespace

std::unique_ptr<const Shapes> ReadType(std::string_view idlText, const std::string &name, std::string &reason)
{
    std::unique_ptr<const Shapes> shapes;
    reason = ReadModel(idlText, false,
                       [&](const RabitIdl::Model &model) { shapes = ShapeBuilder(model).Build(name); });
    return shapes;
}

std::string ReadModel(std::string_view idlText, bool isTrusted,
                      const std::function<void(const RabitIdl::Model &)> &use)
{
    std::string reason = isTrusted ? "" : WhyNotParsed(idlText);
    if (!reason.empty())
    {
        return reason;
    }
    // The parser does not promise to be thread-safe.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const std::string text(idlText);  // ends in zero
    char parserReason[512];
    const std::unique_ptr<const void, FreeState> state(
        RabitParseIdl(text.c_str(), isTrusted, parserReason, sizeof parserReason));
    if (!state)
    {
        return parserReason[0] != '\0' ? Line(parserReason) : "not IDL";
    }
    try
    {
        RabitIdl::Refusals refusals;
        const RabitIdl::Model model = RabitIdl::ModelReader(state.get(), refusals).Read();
        if (!refusals.Empty())
        {
            // A text that is in no file has the line as `:12: reason`.
            return Line(isTrusted ? refusals.First() : "line " + refusals.First().substr(1));
        }
        use(model);
        return "";
    }
    catch (const Refused &refused)
    {
        return Line(refused.what());
    }
}

}  // namespace Rabit::Dynamic
