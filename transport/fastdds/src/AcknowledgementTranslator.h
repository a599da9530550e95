// Makes the vendor accept acknowledgements of readers that have started anew.
//
// A peer may lose us while we do not lose it: it heard nothing for a while, or our process was stopped, and
// its lease for us ran out first. It then finds us as if for the first time, and its readers request all
// samples. The vendor supports that only in the form that its own readers use. It would ignore readers of
// another make, for two reasons. It tells news from repeats and late datagrams by a count that must rise, and
// theirs begins at zero again. And from a reader that had acknowledged more, it takes "I have nothing before
// sample 1" for no news, and only "nothing before sample 0" for a new start. It would then believe for ever
// that the peer knows our endpoints, and they would never match again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <utility>

#include "common/RtpsReader.h"

namespace Rabit::FastDds
{

// Thread-safe, because several sockets receive at once. Calls nothing with its lock held.
class AcknowledgementTranslator
{
public:
    // Converts requests for all samples into the vendor's form, and gives all acknowledgements and fragment
    // requests in a datagram counts of our own. These rise as the sender's do. If a reader that had
    // acknowledged something requests all, the counts of all readers of its participant start anew, above all
    // that were given. A count far below the last one is treated as news as well. The datagram must be
    // sound (RtpsGuard.h).
    void Translate(std::span<std::uint8_t> datagram);

    // Bounded: forgetting an exchange costs no more than needless repairs.
    static constexpr std::size_t MostExchanges = 20'000;
    std::size_t Exchanges() const
    {
        const std::lock_guard lock(_mutex);
        return _exchanges.size();
    }

private:
    // The reader, the writer, and the kind of submessage.
    using Exchange = std::array<std::uint8_t, 9>;
    struct Counts
    {
        std::uint32_t Theirs = 0;
        std::uint32_t Ours = 0;
        bool HadSomething = false;
    };

    void Translate(const Rtps::Submessage &submessage, const Rtps::GuidPrefix &sender);
    bool HadSomething(const Rtps::GuidPrefix &sender, const Exchange &exchange) const;
    std::uint32_t CountOf(const Rtps::GuidPrefix &sender, const Exchange &exchange, std::uint32_t theirs,
                          bool something);
    void Forget(const Rtps::GuidPrefix &sender);

    mutable std::mutex _mutex;  // guards the members below
    std::map<std::pair<Rtps::GuidPrefix, Exchange>, Counts> _exchanges;
    std::uint32_t _highest = 0;  // highest count given
    std::uint32_t _floor = 0;    // value of _highest when an exchange was last forgotten
};

}  // namespace Rabit::FastDds
