#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agreement/AgreementSettings.h"
#include "agreement/ClaimBallots.h"
#include "agreement/ClaimMessages.h"
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

    // The settings must name this node as a member. `fences`: all up to this one may have been accepted.
    AgreementNode(AgreementSettings settings, std::uint64_t fences, std::function<std::uint64_t()> random,
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
    // A fence that must be stored before the voter answers requests that wait for it; empty: there is none.
    std::optional<std::uint64_t> StoreWanted() const { return _ballots.StoreWanted(); }
    // All fences up to this one are stored, or could not be. Answers the requests that waited.
    void Stored(std::uint64_t upTo, bool isStored, Duration now);
    // The clock may have stood still: all claims are lost.
    void ClockStoodStill(Duration now) { _own.ClockStoodStill(now); }

    // When to call TakeDue; empty: nothing is wanted. Answers are due at once.
    std::optional<Duration> Due() const;
    // One datagram that is to be sent now; empty: there is none.
    std::optional<Datagram> TakeDue(Duration now);
    // Gives all claims up, and those that are asked for. Returns the datagrams that tell the others so.
    std::vector<Datagram> Leave(Duration now);

    // The part of a beat that agreements use, in bytes. Renewals and answers of a lease that is in time go
    // with beats alone: datagrams cost far more.
    struct Beat
    {
        std::vector<std::uint8_t> Renewal{};  // session (4), renewal (4); empty: nothing is to be renewed
        // For each renewal that came in a beat: number of the claimant in the sorted list of members (1),
        // hash of its incarnation and session (4), book (4), renewal (4).
        std::vector<std::uint8_t> Answers{};
    };
    static constexpr std::size_t RenewalBytes = 8;
    static constexpr std::size_t AnswerBytes = 13;
    // Answers of one beat. The others go with the next ones.
    static constexpr std::size_t MostBeatAnswers = 16;

    // For the beat that is sent now, which every member gets. The renewal is left out if `renews` is false,
    // and answers beyond `mostAnswers` wait for the next beats.
    Beat TakeBeat(Duration now, bool renews = true, std::size_t mostAnswers = MostBeatAnswers);
    // Answers that the next beat would take.
    std::size_t AnswersForBeat() const { return std::min(_beatAnswers.size(), MostBeatAnswers); }
    // A beat of another node with the same group has come, with any bytes.
    void OnBeat(std::string_view from, std::uint64_t incarnation, const Beat &beat, Duration now);

    std::uint64_t Malformed() const { return _malformed; }

private:
    // Answers that wait to be sent. Of more, the oldest is dropped: its claimant asks again.
    static constexpr std::size_t MostAnswers = 64;

    // Returns the answer for another node; empty: there is none.
    std::optional<ClaimReply> Vote(std::string_view from, const ClaimRequest &request, Duration now);
    void Answer(std::string_view to, const ClaimReply &reply);
    void AnswerInBeat(std::string_view to, const ClaimReply &reply);
    void TakeAnswers(std::string_view from, std::uint64_t incarnation, std::span<const std::uint8_t> answers,
                     Duration now);

    const AgreementSettings _settings;  // with sorted members
    const std::uint64_t _group;
    OwnClaims _own;
    ClaimBallots _ballots;
    std::deque<Datagram> _answers;
    std::deque<std::pair<std::string, ClaimReply>> _beatAnswers;  // to each claimant, the newest
    // The newest request of each member that waits for a fence to be stored.
    std::map<std::string, ClaimRequest, std::less<>> _unstored;
    std::uint64_t _malformed = 0;
};

}  // namespace Rabit
