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

std::string WhyNoRosTopic(std::string_view topic)
{
    constexpr std::size_t Prefix = 3;
    const std::string name = RosTopicName(topic).substr(Prefix);
    if (name.empty() || name.back() == '/' || name.front() == '/' || name.find("//") != std::string::npos)
    {
        return "has an empty part between slashes";
    }
    char before = '/';
    for (const char c : name)
    {
        const bool isDigit = c >= '0' && c <= '9';
        const bool isLetter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        if (!isDigit && !isLetter && c != '/')
        {
            return std::string("has `") + c + "`; ROS 2 allows A-Z a-z 0-9 _ /";
        }
        if (isDigit && before == '/')
        {
            return "has a part that begins with a digit";
        }
        before = c;
    }
    return "";
}

}  // namespace Rabit
