#include "AcknowledgementTranslator.h"

#include <algorithm>

#include "common/RtpsWriter.h"
#include "guard/RtpsMessage.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace
{

// AckNack and NackFrag consist of reader, writer, a sequence number, a set, and the count.
constexpr std::size_t EntitiesSize = 8;
constexpr std::size_t SequenceAt = 8;
constexpr std::size_t CountSize = 4;
// A count farther behind the last one is not merely late: one of the two was forged, and the honest ones go
// on from the lower.
constexpr std::uint32_t FarthestBehind = 16;

}  // namespace

void AcknowledgementTranslator::Translate(std::span<std::uint8_t> datagram)
{
    const std::lock_guard lock(_mutex);
    GuidPrefix sender = SenderOf(datagram);
    VisitSubmessages(datagram,
                     [&](const Submessage &submessage)
                     {
                         if (submessage.Kind == SubmessageKind::InfoSource)
                         {
                             sender = PrefixOf(submessage.Body().subspan(PrefixAt));
                         }
                         const bool acknowledges = submessage.Kind == SubmessageKind::AckNack ||
                                                   submessage.Kind == SubmessageKind::NackFrag;
                         if (acknowledges)
                         {
                             Translate(submessage, sender);
                         }
                     });
}

void AcknowledgementTranslator::Translate(const Submessage &submessage, const GuidPrefix &sender)
{
    const bool isAckNack = submessage.Kind == SubmessageKind::AckNack;
    const auto body = submessage.Body();
    RtpsReader rest = submessage.Reader();
    Exchange exchange{};
    const auto entities = rest.Bytes(EntitiesSize);
    std::copy(entities.begin(), entities.end(), exchange.begin());
    exchange[EntitiesSize] = static_cast<std::uint8_t>(submessage.Kind);
    // The reader has all samples before the base.
    const bool something = rest.U32() != 0 || rest.U32() > 1;
    rest = submessage.Reader();
    rest.Skip(SequenceAt + SequenceSize + (isAckNack ? 0 : 4));  // in front of the set
    const std::uint32_t bits = rest.Bits();
    const std::size_t countAt = rest.Position();
    const std::uint32_t theirs = rest.U32();
    if (!rest.IsGood())
    {
        return;
    }
    if (isAckNack && !something && bits == 0 && (submessage.Flags & FinalFlag) == 0)
    {
        // The reader asks for all.
        if (HadSomething(sender, exchange))
        {
            Forget(sender);
        }
        Write(body.subspan(SequenceAt + 4, 4), 0, submessage.LittleEndian);
    }
    const std::uint32_t count = CountOf(sender, exchange, theirs, isAckNack && something);
    Write(body.subspan(countAt, CountSize), count, submessage.LittleEndian);
}

bool AcknowledgementTranslator::HadSomething(const GuidPrefix &sender, const Exchange &exchange) const
{
    const auto known = _exchanges.find({sender, exchange});
    return known != _exchanges.end() && known->second.HadSomething;
}

std::uint32_t AcknowledgementTranslator::CountOf(const GuidPrefix &sender, const Exchange &exchange,
                                                 std::uint32_t theirs, bool something)
{
    const std::pair key{sender, exchange};
    auto known = _exchanges.find(key);
    if (known == _exchanges.end())
    {
        if (_exchanges.size() >= MostExchanges)
        {
            _exchanges.clear();
            _floor = _highest;
        }
        known = _exchanges.emplace(key, Counts{theirs, _floor + 1, something}).first;
    }
    else if (known->second.Theirs - theirs > FarthestBehind)  // or ahead: unsigned
    {
        known->second = {theirs, known->second.Ours + 1, something};
    }
    _highest = std::max(_highest, known->second.Ours);
    return known->second.Ours;
}

// Its other readers, and its fragment requests for every sample, start new counts as well.
void AcknowledgementTranslator::Forget(const GuidPrefix &sender)
{
    const auto first = _exchanges.lower_bound({sender, {}});
    auto last = first;
    while (last != _exchanges.end() && last->first.first == sender)
    {
        ++last;
    }
    _exchanges.erase(first, last);
    _floor = _highest;
}

}  // namespace Rabit::FastDds
