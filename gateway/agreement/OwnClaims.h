#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimLease.h"
#include "agreement/ClaimMessages.h"
#include "agreement/ClaimVotes.h"

namespace Rabit
{

// A claimant: asks the voters for claims, and renews one lease under which all of them hang.
//
// A claim is asked for at all voters. A majority of grants gives it a fence, one above all that these voters
// know; a majority that has accepted the fence makes it held. It is held until the lease ends that a majority
// of these voters has acknowledged, counted from when the renewal was *sent*. So a claim is lost here before
// any majority may give it to another one.
//
// A pure state machine. Time is passed in: that of a clock that runs on while the computer is suspended. Not
// thread-safe.
class OwnClaims
{
public:
    using Duration = AgreementSettings::Duration;

    // An unanswered order is repeated after this time at first.
    static constexpr Duration FirstRetry = std::chrono::milliseconds(100);
    // Two that asked at the same time may both be refused. They ask again after a random part of this time.
    static constexpr Duration Apart = std::chrono::milliseconds(300);

    struct Event
    {
        enum class Kind : std::uint8_t
        {
            Gained,
            Lost,
            Refused,    // another one has it; a claim that is kept wanted is asked for again
            NoMajority  // too few voters answered within a lease
        };

        Kind What = Kind::Gained;
        std::string Claim;
        std::uint64_t Fence = 0;  // of Gained and Lost
        std::string Holder{};     // of Refused, as far as it is known
    };
    struct Outgoing
    {
        std::string To;  // empty: to all voters
        ClaimRequest Request;
    };

    // The settings must outlive the object.
    OwnClaims(const AgreementSettings &settings, std::function<std::uint64_t()> random);

    // Asks for a claim. `keeps`: it is asked for until GiveUp, whatever becomes of it; else once. Returns
    // false if the name is empty or too long, or if there are too many claims, those among them that voters
    // have not taken back yet. Without effect if it is wanted already.
    bool Want(const std::string &claim, bool keeps, Duration now);
    void GiveUp(const std::string &claim, Duration now);
    // It is held, or asked for.
    bool IsWanted(std::string_view claim) const;
    // The claims that are asked for until GiveUp.
    std::vector<std::string> Kept() const;
    // True if a claim is wanted and not held.
    bool Lacks(Duration now) const;

    // The claims that are held.
    std::vector<std::string> Held(Duration now) const;
    // The fence of a claim that is held; empty: it is not.
    std::optional<std::uint64_t> FenceOf(std::string_view claim, Duration now) const;
    std::vector<Event> TakeEvents() { return std::exchange(_events, {}); }

    // The clock may have stood still: all claims are lost, and kept ones are asked for anew.
    void ClockStoodStill(Duration now);

    void OnReply(std::string_view from, const ClaimReply &reply, Duration now);
    std::uint32_t Session() const { return _lease.Session(); }
    // When TakeDue is to be called; empty: nothing is wanted.
    std::optional<Duration> Due() const;
    // Does what is due, and returns one request; empty: there is none now.
    std::optional<Outgoing> TakeDue(Duration now);
    // Gives all up, and returns the requests that say so, each to one voter.
    std::vector<Outgoing> Leave(Duration now);
    // True if there is a lease to renew.
    bool Renews() const;
    // Returns the renewal that rides in a beat; empty: nothing is to be renewed.
    std::optional<ClaimRequest> RenewByBeat(Duration now);

private:
    enum class Phase : std::uint8_t
    {
        Waiting,  // until RetryAt
        Asking,
        Accepting,
        Held,
        Releasing
    };
    struct Claim
    {
        ClaimVotes Votes;
        Phase Now = Phase::Asking;
        bool Keeps = false;
        Duration Since{0};     // of the phase
        Duration RetryAt{0};   // of Waiting, and of Releasing a claim that is kept wanted
        bool Refused = false;  // since Asking began
        Duration Patience{0};
        Duration AskAgainAt{0};  // those that refused
    };
    using Claims = std::map<std::string, Claim, std::less<>>;

    void Enter(Claim &claim, Phase phase, Duration now);
    void Begin(Claim &claim, Duration now);
    void Release(Claim &claim, Duration now);
    // Releases the claim. If it is kept wanted, it is asked for again after that time and a random one.
    void GiveWay(Claim &claim, Duration wait, Duration now);
    Duration RandomPart();
    Duration PatienceOf(const Claim &claim) const;
    void Judge(const std::string &name, Claim &claim, Duration now);
    void JudgeAsked(const std::string &name, Claim &claim, Duration now);
    void JudgeReleased(Claim &claim, Duration now);
    void JudgeAll(Duration now);
    Duration HeldUntil(const Claim &claim) const;
    Duration InVainFrom(const Claim &claim) const;
    bool HasOrders(std::string_view voter) const;
    void EndSession();
    void Hurry(Duration now);
    static bool IsWanted(const Claim &claim) { return claim.Now != Phase::Releasing || claim.Keeps; }
    // `which`: all orders, or those alone that were not sent yet.
    enum class Orders : std::uint8_t
    {
        All,
        Unsent
    };
    ClaimRequest OrdersTo(const std::string &voter, Orders which, Duration now);

    const AgreementSettings &_settings;
    const std::function<std::uint64_t()> _random;
    ClaimLease _lease;
    std::map<std::string, BackoffTimer<Duration>, std::less<>> _retries;  // of orders to each voter
    Claims _claims;
    // A voter that did not answer a Release may keep a grant until the session's book ends.
    bool _leftGrants = false;
    std::vector<Event> _events;
};

}  // namespace Rabit
