#include "report/ProblemTexts.h"

#include <rabit/base/Printable.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string_view>
#include <utility>

namespace Rabit
{
namespace
{

// Takes a line from the front, without its end.
std::string_view TakeLine(std::string_view &text)
{
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

}  // namespace

std::string ProblemTexts::ReportOf(const ProblemLog::Standing &standing)
{
    std::string report = std::to_string(standing.Digest) + '\n';
    const std::size_t count = std::min(standing.Problems.size(), MostTexts);
    for (std::size_t i = 0; i < count; ++i)
    {
        const Gateway::Problem &problem = standing.Problems[i];
        report += Printable(problem.subject + ": " + problem.reason, LongestText) + '\n';
    }
    return report;
}

void ProblemTexts::Add(const PeerTable::Peer &node, const std::string &report)
{
    std::string_view rest = report;
    const std::string_view digest = TakeLine(rest);
    Texts texts;
    texts.Incarnation = node.Incarnation;
    if (std::from_chars(digest.data(), digest.data() + digest.size(), texts.Digest).ec != std::errc())
    {
        return;
    }
    while (!rest.empty() && texts.Lines.size() < MostTexts)
    {
        texts.Lines.push_back(Printable(std::string(TakeLine(rest)), LongestText));
    }
    _known[node.Node] = std::move(texts);
}

// A node that has told of its problems tells each change of them.
const ProblemTexts::Texts *ProblemTexts::Find(const PeerTable::Peer &peer) const
{
    const auto known = _known.find(peer.Node);
    const bool isCurrent = known != _known.end() && known->second.Incarnation == peer.Incarnation &&
                           (!peer.HasToldProblems || known->second.Digest == peer.Problems.Digest);
    return isCurrent ? &known->second : nullptr;
}

bool ProblemTexts::Lacks(const PeerTable::Peer &peer) const
{
    const bool mayHave = peer.HasToldProblems ? peer.Problems.Count > 0 : _asksAll;
    return mayHave && peer.State != Gateway::NodeState::LOST && Find(peer) == nullptr;
}

void ProblemTexts::Fill(const PeersOverPaths &peers, Gateway::Fleet &fleet)
{
    const auto hasNone = [](const PeerTable::Peer &peer)
    { return peer.HasToldProblems && peer.Problems.Count == 0; };
    std::erase_if(_known,
                  [&](const auto &entry)
                  {
                      const PeerTable::Peer *peer = peers.Find(entry.first);
                      return peer == nullptr || hasNone(*peer);
                  });
    _told.clear();
    for (Gateway::NodeStatus &status : fleet.nodes)
    {
        const PeerTable::Peer *peer = peers.Find(status.node);
        if (peer == nullptr || peer->State == Gateway::NodeState::LOST)
        {
            continue;
        }
        status.problems = peer->Problems.Count;
        if (const Texts *texts = Find(*peer))
        {
            status.problem_texts.assign(texts->Lines.begin(), texts->Lines.end());
            // A node that refuses words sends its digest alone.
            const bool hasAny = texts->Digest != ProblemLog("").Lasted(std::chrono::nanoseconds(0)).Digest;
            const auto least = std::max<std::size_t>(texts->Lines.size(), hasAny ? 1 : 0);
            status.problems = std::max(status.problems, static_cast<std::uint32_t>(least));
            _told.insert(status.node);
        }
        else if (hasNone(*peer))
        {
            _told.insert(status.node);
        }
    }
}

}  // namespace Rabit
