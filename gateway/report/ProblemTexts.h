#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gateway.idl.h"
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

    // Returns the report of this node.
    static std::string ReportOf(const ProblemLog::Standing &standing);

    // Takes the report of a node: any bytes.
    void Add(const std::string &node, const std::string &report);
    // True if the node has problems, and those texts have not come.
    bool Lacks(const PeerTable::Peer &peer) const;
    // Fills the numbers and texts of problems, and forgets the texts of nodes without a problem.
    // Only after FleetReport::FillNodes.
    void Fill(const PeerTable &peers, Gateway::Fleet &fleet);

private:
    struct Texts
    {
        std::uint32_t Digest = 0;
        std::vector<std::string> Lines;
    };

    std::map<std::string, Texts> _known;  // by node
};

}  // namespace Rabit
