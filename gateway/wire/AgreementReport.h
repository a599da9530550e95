#pragma once

#include <rabit/gateway/Claims.h>
#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The report of a node on its claims (NodeReports::Kind::Agreement). The first line is `members`, the lease
// in ms, and the sorted names of the members. A line `claim`, fence and name follows for each claim that the
// node holds. Tabs are between the words of a line. The report of a node without an agreement is empty.
namespace Rabit::AgreementReport
{

struct Held
{
    std::string Claim;
    std::uint64_t Fence = 0;

    bool operator==(const Held &) const = default;
};

struct Contents
{
    std::vector<std::string> Members{};  // of the node's list, sorted; empty: it has no agreement
    std::chrono::milliseconds Lease{0};
    std::vector<Held> Holdings{};  // by name

    bool operator==(const Contents &) const = default;
};

// The claims that the node holds now.
Contents Of(const AgreementRule &rule, const Claims &claims);
std::string TextOf(const Contents &contents);
// Empty if the report, any bytes, makes no sense. Texts are printable ASCII. At most MostAgreementMembers
// members and Claims::Most claims are accepted.
std::optional<Contents> ContentsOf(std::string_view report);

}  // namespace Rabit::AgreementReport
