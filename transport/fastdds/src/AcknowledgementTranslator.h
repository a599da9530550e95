// Has the vendor listen to readers that begin anew.
//
// A peer whose lease for us ran out while ours for it did not (it heard nothing for a while, or our process
// was stopped) has forgotten us and finds us again as if for the first time: its readers ask for all that
// there is. The vendor provides for that, but in the form that its own readers use alone. Those of another
// make it would not hear, for two reasons: it tells repeats and stragglers from news by a count that must
// rise, and theirs begins at zero again; and it takes "I have nothing before sample 1" for no news of a
// reader that had acknowledged more, "nothing before sample 0" for a new beginning. It would believe for ever
// that the peer knows our endpoints, and they would never match again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

namespace Rabit::FastDds
{

// Not thread-safe.
class AcknowledgementTranslator
{
public:
    // Puts requests for all that there is into the vendor's form, and gives all acknowledgements and requests
    // for fragments in a datagram counts of our own. They rise as the sender's do; but when one of the
    // sender's readers that had acknowledged something asks for all, those of all its readers begin anew,
    // above all that were given. A count far below the last is news as well. What DDS Security may have
    // signed stays. The datagram must be sound (RtpsGuard.h).
    void Translate(std::span<std::uint8_t> datagram);

    // To forget does no harm beyond repairs that were not needed, so this is all that is kept.
    static constexpr std::size_t MostExchanges = 20'000;
    std::size_t Exchanges() const { return _exchanges.size(); }

private:
    using Prefix = std::array<std::uint8_t, 12>;
    // The reader, the writer, and the kind of submessage.
    using Exchange = std::array<std::uint8_t, 9>;
    struct Counts
    {
        std::uint32_t Theirs = 0;
        std::uint32_t Ours = 0;
        bool HadSomething = false;
    };

    bool HadSomething(const Prefix &sender, const Exchange &exchange) const;
    std::uint32_t CountOf(const Prefix &sender, const Exchange &exchange, std::uint32_t theirs,
                          bool something);
    void Forget(const Prefix &sender);

    std::map<std::pair<Prefix, Exchange>, Counts> _exchanges;
    std::uint32_t _highest = 0;  // of all counts given
    std::uint32_t _floor = 0;    // the highest when something was forgotten last
};

}  // namespace Rabit::FastDds
