#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "paths/PeersOverPaths.h"
#include "presence/PeerTable.h"
#include "report/ProblemLog.h"

namespace Rabit
{

// The problems of nodes in words, as the nodes send them to those who request them
// (NodeReports::Kind::Problems): the digest, and a line for each of the first problems.
//
// Gateway's thread only.
class ProblemTexts
{
public:
    static constexpr std::size_t MostTexts = 8;
    static constexpr std::size_t LongestText = 300;

    // `asksAll`: also asks nodes that have told of no problem since they are heard. Beats tell of problems
    // only now and then, and a tool does not stay that long.
    explicit ProblemTexts(bool asksAll = false) : _asksAll(asksAll) {}

    // Returns the report of this node.
    static std::string ReportOf(const ProblemLog::Standing &standing);

    // Takes the report of a node: any bytes.
    void Add(const PeerTable::Peer &node, const std::string &report);
    // True if the node has problems, or may have, and those texts have not come.
    bool Lacks(const PeerTable::Peer &peer) const;
    // Fills the numbers and texts of problems, and forgets the texts of nodes without a problem.
    // Only after FleetReport::FillNodes.
    void Fill(const PeersOverPaths &peers, Gateway::Fleet &fleet);
    // True if the last Fill had a report of that node for all its problems, or that it has none.
    bool AreTold(const std::string &node) const { return _told.contains(node); }

private:
    struct Texts
    {
        std::uint64_t Incarnation = 0;  // of the node
        std::uint32_t Digest = 0;
        std::vector<std::string> Lines;
    };
    // The report of its present problems; null: it has not come.
    const Texts *Find(const PeerTable::Peer &peer) const;

    const bool _asksAll;
    std::map<std::string, Texts> _known;  // by node
    std::set<std::string> _told;
};

}  // namespace Rabit
