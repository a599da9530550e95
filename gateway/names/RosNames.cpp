#include "names/RosNames.h"

namespace Rabit
{

std::string RosTopicName(std::string_view topic)
{
    for (const std::string_view prefix : {"rt/", "rq/", "rr/"})
    {
        if (topic.substr(0, prefix.size()) == prefix)
        {
            return std::string(topic);
        }
    }
    topic.remove_prefix(!topic.empty() && topic.front() == '/' ? 1 : 0);
    return std::string("rt/").append(topic);
}

std::string RosTypeName(std::string_view type)
{
    constexpr std::string_view Module = "dds_::";
    const std::size_t separator = type.rfind("::");
    const std::size_t name = separator == std::string_view::npos ? 0 : separator + 2;
    const bool isMangled = name >= Module.size() &&
                           type.substr(name - Module.size(), Module.size()) == Module && type.back() == '_';
    return isMangled ? std::string(type)
                     : std::string(type.substr(0, name)) + std::string(Module) +
                           std::string(type.substr(name)) + "_";
}

}  // namespace Rabit
