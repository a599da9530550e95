#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agreement/ClaimMessages.h"

namespace Rabit
{

// The votes of all voters on one claim of this node, and the orders that are still to be given. Knows no
// time.
//
// Fences rise: a claim is held if each voter of a majority accepted a fence above all that this voter knew
// when it granted. A voter that grants later than others may know a higher one. The fence then rises, and all
// are told again. After the claim is held its fence stays.
//
// A pure state machine. Not thread-safe.
class ClaimVotes
{
public:
    enum class Kind : std::uint8_t
    {
        Unknown,
        Granted,
        Accepted,
        Refused
    };
    struct Refusal
    {
        std::string Holder;  // empty: not known
        std::chrono::milliseconds Wait{0};
    };

    // Voters of later calls must be among these; else they throw std::out_of_range.
    ClaimVotes(std::string claim, const std::vector<std::string> &voters);

    // Asks all voters, from the beginning. A voter that has granted the claim before is asked, too.
    void Ask();
    // Takes a fence above all that the granting voters know, and tells it.
    void Accept();
    // The claim is held: its fence stays.
    void Hold() { _aim = Aim::Holding; }
    // Takes back what any voter may have granted.
    void Release();
    // Asks the voters again that refused: another one may have given way since.
    void AskRefusedAgain();
    // The voter has a new book, which has no grants.
    void ForgetBookOf(std::string_view voter);
    // The session has ended, or the voters that have not answered are gone.
    void ForgetAll();

    std::optional<ClaimOrder> OrderTo(std::string_view voter) const;
    // True if the present order has not been sent yet.
    bool IsUnsent(std::string_view voter) const;
    // The present order goes in the request with this number.
    void Sent(std::string_view voter, std::uint32_t number);
    // Takes a result for the request with this number. Returns true if that changed orders to other voters.
    bool Take(std::string_view voter, std::uint32_t number, std::uint64_t fences, const ClaimResult &result);

    std::uint64_t Fence() const { return _fence; }
    std::size_t Count(Kind kind) const { return VotersThat(kind).size(); }
    std::vector<std::string_view> VotersThat(Kind kind) const
    {
        return VotersWith([kind](const Vote &vote) { return vote.What == kind; });
    }
    // Voters that may have granted the claim to this node.
    std::vector<std::string_view> VotersThatWereAsked() const
    {
        return VotersWith([](const Vote &vote) { return vote.WasAsked; });
    }
    // The longest of all refusals.
    Refusal LongestRefusal() const;

private:
    enum class Aim : std::uint8_t
    {
        Grants,
        Acceptances,
        Holding,
        Release
    };
    struct Vote
    {
        Kind What = Kind::Unknown;
        // An Ask went to the present book of the voter, and no Release was answered since. A repeated Ask may
        // be granted after its first copy was refused.
        bool WasAsked = false;
        std::uint32_t Since = 0;   // number of the first request with the present order; 0: none
        std::uint64_t Fences = 0;  // that the voter knew when it granted
        std::chrono::milliseconds Wait{0};
        std::string Holder{};
    };

    const Vote &Of(std::string_view voter) const { return _votes.at(std::string(voter)); }
    Vote &Of(std::string_view voter) { return _votes.at(std::string(voter)); }
    void Aims(Aim aim);
    bool TakeGrant(Vote &vote, std::uint64_t fences);
    template <typename Is>
    std::vector<std::string_view> VotersWith(const Is &is) const
    {
        std::vector<std::string_view> voters;
        for (const auto &[name, vote] : _votes)
        {
            if (is(vote))
            {
                voters.push_back(name);
            }
        }
        return voters;
    }

    const std::string _claim;
    Aim _aim = Aim::Release;
    std::uint64_t _fence = 0;
    std::map<std::string, Vote> _votes;
};

}  // namespace Rabit
