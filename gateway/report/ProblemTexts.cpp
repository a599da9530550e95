#include "report/ProblemTexts.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

namespace Rabit
{
namespace
{

// Returns one line of printable ASCII, not too long: the text may come from the network.
std::string Clean(std::string text)
{
    if (text.size() > ProblemTexts::LongestText)
    {
        text.resize(ProblemTexts::LongestText - 3);
        text += "...";
    }
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

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
        report += Clean(problem.subject + ": " + problem.reason) + '\n';
    }
    return report;
}

void ProblemTexts::Add(const std::string &node, const std::string &report)
{
    std::string_view rest = report;
    const std::string_view digest = TakeLine(rest);
    Texts texts;
    if (std::from_chars(digest.data(), digest.data() + digest.size(), texts.Digest).ec != std::errc())
    {
        return;
    }
    while (!rest.empty() && texts.Lines.size() < MostTexts)
    {
        texts.Lines.push_back(Clean(std::string(TakeLine(rest))));
    }
    _known[node] = std::move(texts);
}

bool ProblemTexts::Lacks(const PeerTable::Peer &peer) const
{
    if (peer.Problems.Count == 0 || peer.State == Gateway::NodeState::LOST)
    {
        return false;
    }
    const auto known = _known.find(peer.Node);
    return known == _known.end() || known->second.Digest != peer.Problems.Digest;
}

void ProblemTexts::Fill(const PeerTable &peers, Gateway::Fleet &fleet)
{
    std::erase_if(_known,
                  [&peers](const auto &entry)
                  {
                      const PeerTable::Peer *peer = peers.Find(entry.first);
                      return peer == nullptr || peer->Problems.Count == 0;
                  });
    for (Gateway::NodeStatus &status : fleet.nodes)
    {
        const PeerTable::Peer *peer = peers.Find(status.node);
        if (peer == nullptr || peer->State == Gateway::NodeState::LOST)
        {
            continue;
        }
        status.problems = peer->Problems.Count;
        const auto known = _known.find(status.node);
        if (known != _known.end() && known->second.Digest == peer->Problems.Digest)
        {
            status.problem_texts.assign(known->second.Lines.begin(), known->second.Lines.end());
        }
    }
}

}  // namespace Rabit
