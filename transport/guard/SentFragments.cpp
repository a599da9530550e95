#include "guard/SentFragments.h"

#include "guard/RtpsReader.h"

namespace Rabit::Rtps
{

namespace
{

// More than a history keeps of samples that are large enough for fragments.
constexpr std::size_t MostSamples = 4096;

}  // namespace

void SentFragments::Sent(std::span<const std::uint8_t> datagram)
{
    // It is our own and therefore sound. Beside fragments a datagram has only a time and a destination, so
    // the walk is short.
    RtpsReader rest(datagram, true);
    rest.Skip(RtpsHeaderSize);
    while (rest.Left() >= SubmessageHeaderSize)
    {
        const auto head = rest.Bytes(2);
        const std::uint16_t length = rest.U16();
        const auto body = rest.Bytes(length == 0 ? rest.Left() : length);
        if (static_cast<SubmessageKind>(head[0]) != SubmessageKind::DataFrag)
        {
            continue;
        }
        RtpsReader fragment(body, true);
        fragment.Skip(8);  // flags, where the inline QoS is, the reader
        const EntityId writer = fragment.Entity();
        const std::int64_t sequence = fragment.Sequence();
        fragment.Skip(6);  // fragment number and count
        const std::uint32_t size = fragment.U16();
        const std::uint32_t whole = fragment.U32();
        if (!fragment.IsGood() || size == 0)
        {
            return;
        }
        if (_fragments.insert_or_assign({writer, sequence}, (whole + size - 1) / size).second)
        {
            _order.emplace_back(writer, sequence);
        }
        if (_order.size() > MostSamples)
        {
            _fragments.erase(_order.front());
            _order.pop_front();
        }
    }
}

bool SentFragments::Has(EntityId writer, std::int64_t sequence, std::uint32_t fragment) const
{
    const auto found = _fragments.find({writer, sequence});
    return found != _fragments.end() && fragment >= 1 && fragment <= found->second;
}

}  // namespace Rabit::Rtps
