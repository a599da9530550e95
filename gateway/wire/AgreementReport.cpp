#include "wire/AgreementReport.h"

#include <rabit/base/NumberIn.h>
#include <rabit/base/Printable.h>

#include <algorithm>
#include <cstddef>

#include "wire/NodeReports.h"
#include "wire/ReportLines.h"

namespace Rabit::AgreementReport
{
namespace
{

constexpr std::size_t LongestText = Claims::LongestName;  // and that of a node's name
constexpr std::size_t MembersOfClaim = 3;
// With the word, the number and the tabs of a line.
constexpr std::size_t LongestLine = LongestText + 40;
static_assert((MostAgreementMembers + Claims::Most) * LongestLine <= NodeReports::Largest);

bool TakeMembers(const std::vector<std::string> &words, Contents &contents)
{
    const auto lease = words.size() > 2 ? NumberIn<std::chrono::milliseconds::rep>(words[1]) : std::nullopt;
    if (!lease || *lease <= 0 || words.size() > MostAgreementMembers + 2 || words[0] != "members" ||
        std::find(words.begin() + 2, words.end(), "") != words.end())
    {
        return false;
    }
    contents.Lease = std::chrono::milliseconds(*lease);
    contents.Members.assign(words.begin() + 2, words.end());
    return true;
}

bool TakeClaim(const std::vector<std::string> &words, Contents &contents)
{
    const auto fence = words.size() == MembersOfClaim ? NumberIn<std::uint64_t>(words[1]) : std::nullopt;
    if (!fence || words[0] != "claim" || words[2].empty() || contents.Holdings.size() == Claims::Most)
    {
        return false;
    }
    contents.Holdings.push_back({.Claim = words[2], .Fence = *fence});
    return true;
}

}  // namespace

Contents Of(const AgreementRule &rule, const Claims &claims)
{
    Contents contents{.Members = rule.Members, .Lease = rule.Lease};
    std::sort(contents.Members.begin(), contents.Members.end());
    for (const std::string &claim : claims.Mine())
    {
        // The lease may end between the two calls.
        if (const auto fence = claims.FenceOf(claim))
        {
            contents.Holdings.push_back({.Claim = claim, .Fence = *fence});
        }
    }
    return contents;
}

std::string TextOf(const Contents &contents)
{
    if (contents.Members.empty())
    {
        return "";
    }
    std::string text = "members\t" + std::to_string(contents.Lease.count());
    for (const std::string &member : contents.Members)
    {
        text += '\t' + member;
    }
    text += '\n';
    for (const Held &held : contents.Holdings)
    {
        text += "claim\t" + std::to_string(held.Fence) + '\t' + Printable(held.Claim) + '\n';
    }
    return text;
}

std::optional<Contents> ContentsOf(std::string_view report)
{
    Contents contents;
    if (report.empty())
    {
        return contents;
    }
    bool makesSense = TakeMembers(
        ReportLines::MembersOf(ReportLines::TakeLine(report), MostAgreementMembers + 2, LongestText),
        contents);
    while (makesSense && !report.empty())
    {
        makesSense = TakeClaim(
            ReportLines::MembersOf(ReportLines::TakeLine(report), MembersOfClaim, LongestText), contents);
    }
    return makesSense ? std::optional(contents) : std::nullopt;
}

}  // namespace Rabit::AgreementReport
