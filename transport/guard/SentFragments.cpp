#include "guard/SentFragments.h"

#include "common/RtpsReader.h"

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
    VisitSubmessages(datagram,
                     [this](const ConstSubmessage &part)
                     {
                         if (part.Kind == SubmessageKind::DataFrag)
                         {
                             Sent(part.Reader());
                         }
                     });
}

void SentFragments::Sent(RtpsReader fragment)
{
    fragment.Skip(WriterInData);
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

bool SentFragments::Has(EntityId writer, std::int64_t sequence, std::uint32_t fragment) const
{
    const auto found = _fragments.find({writer, sequence});
    return found != _fragments.end() && fragment >= 1 && fragment <= found->second;
}

}  // namespace Rabit::Rtps
