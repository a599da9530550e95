#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backfill.idl.h"

namespace Rabit::Backfill
{

// Decides which bytes of a file of another node to request next, and takes in the answers. Some parts are
// requested ahead, so that the channel is never idle; these are what a restart of an end costs.
//
// A pure state machine; `now` never goes back. Not thread-safe.
class FileFetch
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr std::uint64_t PartSize = 16U << 10;
    static constexpr std::size_t MostAhead = 4;
    // Time in which the node is UP until an answer is taken for lost.
    static constexpr Duration Patience = std::chrono::seconds(120);
    // Until a question that could not be sent is sent again.
    static constexpr Duration Pause = std::chrono::milliseconds(500);

    // The first `have` bytes are here already.
    FileFetch(std::string name, std::uint64_t have, std::uint64_t firstNumber)
        : _name(std::move(name)), _have(have), _nextNumber(firstNumber)
    {
    }

    // The state of the node, whenever it may have changed.
    void SetNode(std::uint64_t incarnation, bool isUp, Duration now);
    // Questions to send now. Failed must be called of each that cannot be delivered: all that were asked
    // after it are asked again, too, as parts are taken in order.
    std::vector<Question> Due(Duration now);
    void Failed(std::uint64_t number, Duration now);

    // Returns the bytes to append to the file, which are valid as long as the answer; empty: none.
    std::span<const std::uint8_t> Answered(const Answer &answer, Duration now);
    // All is to be fetched from its beginning on.
    void StartOver();

    struct Facts
    {
        std::uint64_t Size = 0;
        std::vector<std::uint8_t> Hash;
    };
    // Empty until the node has told.
    const std::optional<Facts> &What() const { return _facts; }
    std::uint64_t Have() const { return _have; }
    bool IsWhole() const { return _facts && _have >= _facts->Size; }
    // Why the node does not send the file; empty: it does.
    const std::string &Refusal() const { return _refusal; }
    // Bytes that came and were here already.
    std::uint64_t Repeated() const { return _repeated; }

private:
    struct Asked
    {
        std::uint64_t Number = 0;
        std::uint64_t End = 0;  // the byte behind it
    };

    void AskAgain(Duration at);

    const std::string _name;
    std::uint64_t _have;
    std::uint64_t _nextNumber;
    std::optional<Facts> _facts;
    std::deque<Asked> _asked;  // in the order of the questions
    std::uint64_t _askedUntil = 0;
    std::uint64_t _incarnation = 0;
    bool _isUp = false;
    Duration _patientUntil{0};
    Duration _notBefore{0};
    std::uint64_t _repeated = 0;
    std::string _refusal;
};

}  // namespace Rabit::Backfill
