#include "FleetType.h"

namespace Rabit::Tool
{

FleetType FetchType(FleetSession &session, const std::vector<std::string> &nodes, const std::string &name,
                    std::uint64_t definition, double until)
{
    // Seconds to wait for a node's answer before the next node is asked.
    constexpr double patience = 1.0;
    FleetType type;
    const auto has = [&] { return session.Explorer().TypeText(definition).has_value(); };
    for (std::size_t i = 0; i < nodes.size() && !has(); ++i)
    {
        session.Explorer().AskForType(nodes[i], name, definition);
        const bool isLast = i + 1 == nodes.size();
        session.WaitUntil(isLast ? until : std::min(until, session.Seconds() + patience), has);
    }
    const auto text = session.Explorer().TypeText(definition);
    if (!text)
    {
        type.Reason = "the type `" + name +
                      "` could not be had: " + (nodes.empty() ? "nobody" : nodes.back()) +
                      " does not hand it out (an older gateway?), or its answer does not get through";
        return type;
    }
    type.Text = *text;
    ParsedType parsed = DynamicType::Parse(*text, name);
    type.Type = parsed.Type;
    type.Reason = parsed.Type ? "" : "the type `" + name + "` cannot be used: " + parsed.Reason;
    return type;
}

}  // namespace Rabit::Tool
