#include "keys/MemberCheck.h"

#include <rabit/base/UtcText.h>

#include <boost/algorithm/string/join.hpp>

namespace Rabit::Keys
{
namespace
{

constexpr const char *DayFormat = "%Y-%m-%d";

void AddTopics(const char *verb, const Envelope::Permissions &allowed,
               bool Envelope::Permissions::Rule::*what, std::vector<std::string> &lines)
{
    std::vector<std::string> topics;
    for (const Envelope::Permissions::Rule &rule : allowed.Rules())
    {
        if (rule.*what)
        {
            topics.push_back(rule.Topic == "*" ? "everything" : rule.Topic);
        }
    }
    if (!topics.empty())
    {
        lines.push_back(verb + boost::algorithm::join(topics, ", "));
    }
}

}  // namespace

std::vector<KeysFinding> WhatIsTooMuch(const Envelope::Certificate &certificate,
                                       const Envelope::Permissions &allowed)
{
    std::vector<KeysFinding> findings;
    const bool isTool = certificate.Role == Envelope::CertificateRole::Tool;
    for (const Envelope::Permissions::Rule &rule : allowed.Rules())
    {
        if (rule.Topic.find_first_of("*?") == std::string::npos)
        {
            continue;
        }
        const std::string rest = " topics by the pattern `" + rule.Topic + "`; name each one";
        if (rule.MayWrite)
        {
            findings.push_back({true, "may write" + rest});
        }
        if (rule.MayRead && !isTool)
        {
            findings.push_back({true, "may read" + rest});
        }
    }
    return findings;
}

std::vector<KeysFinding> WhatEnds(const Envelope::Certificate &certificate, std::time_t now, int days)
{
    constexpr std::time_t day = 24 * 60 * 60;
    const auto begins = static_cast<std::time_t>(certificate.Begins);
    const auto ends = static_cast<std::time_t>(certificate.Ends);
    const std::time_t left = (ends - now) / day;
    if (now < begins)
    {
        return {{true, "begins on " + UtcText(begins, DayFormat) + ", and the clock here says " +
                           UtcText(now, DayFormat)}};
    }
    if (now > ends)
    {
        return {{true, "ended on " + EndOf(certificate) + "; renew it"}};
    }
    if (left < days)
    {
        return {{true, "ends on " + EndOf(certificate) + ", in " + std::to_string(left) + " days; renew it"}};
    }
    return {};
}

std::string EndOf(const Envelope::Certificate &certificate)
{
    return UtcText(static_cast<std::time_t>(certificate.Ends), DayFormat);
}

std::vector<std::string> WhoMayWhat(const Envelope::Permissions &allowed)
{
    std::vector<std::string> lines;
    AddTopics("writes ", allowed, &Envelope::Permissions::Rule::MayWrite, lines);
    AddTopics("reads ", allowed, &Envelope::Permissions::Rule::MayRead, lines);
    return lines;
}

}  // namespace Rabit::Keys
