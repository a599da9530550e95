#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "presence/DelayNotes.h"
#include "presence/OffersAnswer.h"
#include "presence/PeerTable.h"
#include "presence/StateQuestions.h"
#include "types/TypeQuestions.h"
#include "wire/AgreementNews.h"
#include "wire/BeatFormat.h"
#include "wire/LinkStrain.h"
#include "wire/ProblemCount.h"

namespace Rabit
{

// Collects the contents of this node's beats and fits them in: the number of problems first, then strains of
// links, questions, echoes and delays, a requested part of the announcement, and the versions of States. Room
// for the worst strain and for a small part of the announcement is kept before questions are added. Contents
// that do not fit follow in the next beats. While another node has this node's name, a beat without
// such a part tells now and then where this node runs. Used by the gateway's thread only.
class BeatContents
{
public:
    using Duration = std::chrono::nanoseconds;

    // Time between two beats that tell where this node runs.
    static constexpr Duration PlacePeriod = std::chrono::seconds(3);

    // `peers` must outlive the object.
    BeatContents(PeerTable &peers, RandomSource random) : _answer(std::move(random)), _peers(peers) {}

    // Sets the encoded announcement of this node, and the number of States in it.
    void Begin(std::vector<std::uint8_t> offers, std::size_t states);
    std::uint32_t OffersDigest() const { return _digest; }

    OffersAnswer &Answer() { return _answer; }
    StateQuestions &Questions() { return _questions; }
    TypeQuestions &Types() { return _types; }
    const TypeQuestions &Types() const { return _types; }
    DelayNotes &Delays() { return _delays; }
    std::size_t States() const { return _states.size(); }
    void SetStateVersion(std::size_t state, std::uint32_t version) { _states.at(state) = version; }

    // A node that beats seldom sends echoes and reports of small delays seldom, too.
    void SetBeatPeriod(Duration period)
    {
        _peers.SetBeatPeriod(period);
        _delays.SetBeatPeriod(period);
    }

    // This node is a tool, and its beats say so.
    void BeTool() { _isTool = true; }
    // Each beat tells of an agreement from now on. A beat without room for BeatFormat::Agreement(0, 0) bytes
    // does not.
    struct AgreementSource
    {
        std::function<std::size_t()> Size;  // bytes that the next beat would take for it
        // For the beat that is sent now, in that many bytes at most.
        std::function<AgreementNews(std::size_t room)> Take;
    };
    void SetAgreement(AgreementSource agreement) { _agreement = std::move(agreement); }
    bool HasAgreement() const { return static_cast<bool>(_agreement.Take); }
    // This node plays a recording, and its beats say so.
    void BeReplay() { _isReplay = true; }

    // Sets the troubles of this node's links, the worst first. From now on each beat reports as many of them
    // as fit.
    void SetStrains(std::vector<LinkStrain> strains) { _strains = std::move(strains); }

    // Sets the nodes that are heard by this path and by no better one, by their sorted tags, which the beats
    // from now on tell.
    void SetFirstHeard(std::vector<std::uint32_t> tags) { _firstHeard = std::move(tags); }

    // Time between two beats that tell the number of this node's problems. After a change, or if somebody has
    // come, some beats in a row tell it.
    static constexpr Duration ProblemPeriod = std::chrono::seconds(10);
    static constexpr int ProblemBeats = 3;
    void SetProblems(const ProblemCount &problems);
    // Somebody has come.
    void RepeatProblems() { _problemBeats = _problems.Count > 0 ? ProblemBeats : _problemBeats; }

    // After a tool has come, and after each change of the fleet while tools are there, this many beats in a
    // row tell which nodes this one hears.
    static constexpr int FleetSumBeats = 3;
    // True if a tool has come since the last LookAtFleet.
    bool HasToolCome() const { return _peers.ToolsCome() != _toolsCome; }
    // Processes tools that have come and nodes that came or went. It walks over all peers. Call before Size.
    void LookAtFleet();

    // When a question is due, which need not wait for the next period; empty: no question is due.
    std::optional<Duration> QuestionDue() const;
    // When a part of the announcement is to be sent.
    std::optional<Duration> AnswerDue() const { return _answer.Due(); }

    // Largest size of the next beat's body, in bytes.
    std::size_t Size(Duration now) const;
    // Size of a body in which the agreement fits, and a part of the announcement, if one is due.
    std::size_t LeastSize(Duration now) const;
    // Fills the beat with the contents that are due now and fit into a body of `most` bytes.
    void Fill(Gateway::Beat &beat, Duration now, std::size_t most);

private:
    void AddTypes(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddWants(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddPart(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddStates(Gateway::Beat &beat, std::size_t &room);
    std::size_t SizeOfMarks() const;
    std::size_t SizeOfAgreement() const { return HasAgreement() ? _agreement.Size() : 0; }
    // Empty: there is none, or no room for it. Takes its room.
    std::optional<AgreementNews> TakeAgreement(std::size_t &room);
    std::size_t SizeOfFleetSum() const;
    std::size_t SizeOfWorstStrain() const;
    std::size_t StrainsWithin(std::size_t room) const;
    std::size_t SizeOfLeastPart(Duration now) const;
    std::size_t SizeOfProblems(Duration now) const;
    std::size_t SizeOfPart(Duration now, std::size_t room) const;
    bool IsPlaceDue(Duration now) const;

    OffersAnswer _answer;
    StateQuestions _questions;
    TypeQuestions _types;
    DelayNotes _delays;
    PeerTable &_peers;
    bool _isTool = false;
    bool _isReplay = false;
    AgreementSource _agreement{};  // empty: there is none
    std::vector<LinkStrain> _strains;
    std::vector<std::uint32_t> _firstHeard;  // sorted
    std::size_t _nextFirstHeard = 0;
    ProblemCount _problems;
    int _problemBeats = 0;  // that tell it in a row
    Duration _problemsSaid{0};
    std::vector<std::uint8_t> _offers;
    std::uint32_t _digest = 0;
    std::vector<std::uint32_t> _states;  // versions
    std::size_t _nextState = 0;
    std::optional<Duration> _placeSaid;
    std::uint64_t _toolsCome = 0;
    std::uint32_t _fleetSum = 0;
    int _fleetSumBeats = 0;  // that tell it in a row
};

}  // namespace Rabit
