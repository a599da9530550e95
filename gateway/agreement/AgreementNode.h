#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimBallots.h"
#include "agreement/ClaimMessages.h"
#include "agreement/FenceStore.h"
#include "agreement/OwnClaims.h"

namespace Rabit
{

// One member of an agreement: a claimant and a voter, and the datagrams between them and the other members.
// Its own vote needs no network.
//
// A pure state machine. Time is passed in: that of a clock that runs on while the computer is suspended
// (CLOCK_BOOTTIME). Not thread-safe.
class AgreementNode
{
public:
    using Duration = AgreementSettings::Duration;

    struct Datagram
    {
        std::string To;  // empty: all members
        std::vector<std::uint8_t> Bytes;
    };

    // The settings must name this node as a member. The store must outlive the object.
    AgreementNode(AgreementSettings settings, FenceStore &store, std::function<std::uint64_t()> random,
                  Duration now);
    AgreementNode(const AgreementNode &) = delete;
    AgreementNode &operator=(const AgreementNode &) = delete;

    OwnClaims &Own() { return _own; }
    const OwnClaims &Own() const { return _own; }
    const ClaimBallots &Ballots() const { return _ballots; }

    // Takes a datagram of another node, of any bytes.
    void OnDatagram(std::string_view from, std::span<const std::uint8_t> bytes, Duration now);
    // Another live node has this node's name: this one does not vote until that has passed.
    void NameIsTaken(Duration now) { _ballots.NameIsTaken(now); }
    // The clock may have stood still: all claims are lost.
    void ClockStoodStill(Duration now) { _own.ClockStoodStill(now); }

    // When to call TakeDue; empty: nothing is wanted. Answers are due at once.
    std::optional<Duration> Due() const;
    // One datagram that is to be sent now; empty: there is none.
    std::optional<Datagram> TakeDue(Duration now);

    // Members that have another list or another lease, and when that was heard last. With them there is no
    // agreement.
    const std::map<std::string, Duration, std::less<>> &OtherGroups() const { return _otherGroups; }
    std::uint64_t Malformed() const { return _malformed; }

private:
    // Answers that wait to be sent. Of more, the oldest is dropped: its claimant asks again.
    static constexpr std::size_t MostAnswers = 64;

    void Vote(std::string_view from, const ClaimRequest &request, Duration now);

    const AgreementSettings _settings;
    OwnClaims _own;
    ClaimBallots _ballots;
    std::deque<Datagram> _answers;
    std::map<std::string, Duration, std::less<>> _otherGroups;  // members alone
    std::uint64_t _malformed = 0;
};

}  // namespace Rabit
