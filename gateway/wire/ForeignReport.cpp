#include "wire/ForeignReport.h"

#include <rabit/base/NumberIn.h>
#include <rabit/base/Printable.h>

#include <cstddef>

#include "wire/NodeReports.h"
#include "wire/ReportLines.h"

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

// True if the line is a topic.
bool Take(std::string_view line, Gateway::ForeignTopic &topic)
{
    const std::vector<std::string> members = ReportLines::MembersOf(line, Members, LongestText);
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
    const auto samples = NumberIn<decltype(topic.samples)>(members[6]);
    const auto readers = NumberIn<decltype(topic.readers)>(members[7]);
    topic.samples = samples.value_or(0);
    topic.readers = readers.value_or(0);
    return FromText(members[1], topic.state) && samples && readers;
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
        Gateway::ForeignTopic topic;
        if (Take(ReportLines::TakeLine(report), topic))
        {
            topics.push_back(topic);
        }
    }
    return topics;
}

}  // namespace Rabit::ForeignReport
