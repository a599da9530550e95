#include "wire/ForeignReport.h"

#include <rabit/base/Printable.h>

#include <charconv>
#include <cstddef>
#include <system_error>

#include "wire/NodeReports.h"

namespace Rabit::ForeignReport
{
namespace
{

constexpr std::size_t LongestText = 300;
constexpr std::size_t Members = 9;

std::string LineOf(const Gateway::ForeignTopic &topic)
{
    std::string line = topic.written ? "written" : "read";
    for (const std::string &member :
         {std::string(ToString(topic.state)), topic.topic, topic.type, topic.local, topic.qos,
          std::to_string(topic.samples), std::to_string(topic.readers), topic.reason})
    {
        line += '\t' + Printable(member, LongestText);
    }
    return line + '\n';
}

template <typename Number>
bool Read(const std::string &text, Number &number)
{
    const char *const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && at == end;
}

// True if the line is a topic.
bool Take(std::string_view line, Gateway::ForeignTopic &topic)
{
    std::vector<std::string> members;
    for (std::size_t begin = 0; begin <= line.size() && members.size() <= Members;)
    {
        const std::size_t end = line.find('\t', begin);
        members.push_back(Printable(std::string(line.substr(begin, end - begin)), LongestText));
        begin = end == std::string_view::npos ? line.size() + 1 : end + 1;
    }
    if (members.size() != Members || (members[0] != "written" && members[0] != "read"))
    {
        return false;
    }
    topic.written = members[0] == "written";
    topic.topic = members[2];
    topic.type = members[3];
    topic.local = members[4];
    topic.qos = members[5];
    topic.reason = members[8];
    return FromText(members[1], topic.state) && Read(members[6], topic.samples) &&
           Read(members[7], topic.readers);
}

}  // namespace

std::string TextOf(const std::vector<Gateway::ForeignTopic> &topics)
{
    std::string text;
    for (const Gateway::ForeignTopic &topic : topics)
    {
        const std::string line = LineOf(topic);
        if (text.size() + line.size() > NodeReports::Largest)
        {
            break;
        }
        text += line;
    }
    return text;
}

std::vector<Gateway::ForeignTopic> TopicsIn(std::string_view report)
{
    std::vector<Gateway::ForeignTopic> topics;
    while (!report.empty())
    {
        const std::size_t end = report.find('\n');
        Gateway::ForeignTopic topic;
        if (Take(report.substr(0, end), topic))
        {
            topics.push_back(topic);
        }
        report.remove_prefix(end == std::string_view::npos ? report.size() : end + 1);
    }
    return topics;
}

}  // namespace Rabit::ForeignReport
