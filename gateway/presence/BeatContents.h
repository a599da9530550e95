#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "presence/DelayNotes.h"
#include "presence/OffersAnswer.h"
#include "presence/PeerTable.h"
#include "presence/StateQuestions.h"
#include "types/TypeQuestions.h"
#include "wire/LinkStrain.h"

namespace Rabit
{

// What this node's beats have to say beside that it is there, and how that is fitted into them: questions
// first, then echoes and delays, then a part of the announcement for who has asked, then the States. What
// does not fit follows in the next beats. While another node has this one's name, a beat without such a part
// says now and then where this one runs. Used by the gateway's thread only.
class BeatContents
{
public:
    using Duration = std::chrono::nanoseconds;

    // Where this node runs is said so often.
    static constexpr Duration PlacePeriod = std::chrono::seconds(3);

    // `peers` must outlive the object.
    BeatContents(PeerTable &peers, RandomSource random) : _answer(std::move(random)), _peers(peers) {}

    // What this node announces, encoded, and how many States there are in it.
    void Begin(std::vector<std::uint8_t> offers, std::size_t states);
    std::uint32_t OffersDigest() const { return _digest; }

    OffersAnswer &Answer() { return _answer; }
    StateQuestions &Questions() { return _questions; }
    TypeQuestions &Types() { return _types; }
    const TypeQuestions &Types() const { return _types; }
    DelayNotes &Delays() { return _delays; }
    std::size_t States() const { return _states.size(); }
    void SetStateVersion(std::size_t state, std::uint32_t version) { _states.at(state) = version; }

    // Who beats seldom echoes seldom, and says seldom that all is well.
    void SetBeatPeriod(Duration period)
    {
        _peers.SetBeatPeriod(period);
        _delays.SetBeatPeriod(period);
    }

    // This node is a tool, and its beats say so.
    void BeTool() { _isTool = true; }
    // What this node posts was recorded before, and its beats say so.
    void BeReplay() { _isReplay = true; }

    // What its links suffer from, the worst first, for each beat to say from now on that has room for it.
    void SetStrains(std::vector<LinkStrain> strains) { _strains = std::move(strains); }

    // When there is something to ask for, which need not wait for the next period.
    std::optional<Duration> QuestionDue() const;
    // When a part of the announcement is to be said.
    std::optional<Duration> AnswerDue() const { return _answer.Due(); }

    // Bytes of the body of the next beat at most.
    std::size_t Size(Duration now) const;
    // Puts into the beat what is to be said now and fits into a body of so many bytes.
    void Fill(Gateway::Beat &beat, Duration now, std::size_t most);

private:
    void AddTypes(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddWants(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddPart(Gateway::Beat &beat, Duration now, std::size_t &room);
    void AddStates(Gateway::Beat &beat, std::size_t &room);
    std::size_t SizeOfMarks() const;
    std::size_t SizeOfStrains() const;
    std::size_t SizeOfPart(Duration now, std::size_t room) const;
    bool IsPlaceDue(Duration now) const;

    OffersAnswer _answer;
    StateQuestions _questions;
    TypeQuestions _types;
    DelayNotes _delays;
    PeerTable &_peers;
    bool _isTool = false;
    bool _isReplay = false;
    std::vector<LinkStrain> _strains;
    std::vector<std::uint8_t> _offers;
    std::uint32_t _digest = 0;
    std::vector<std::uint32_t> _states;  // versions
    std::size_t _nextState = 0;
    std::optional<Duration> _placeSaid;
};

}  // namespace Rabit
