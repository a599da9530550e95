#include "guard/SentFragments.h"

#include "common/RtpsReader.h"

namespace Rabit::Rtps
{

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
    _fragments.Put({writer, sequence}, (whole + size - 1) / size);
}

bool SentFragments::Has(EntityId writer, std::int64_t sequence, std::uint32_t fragment) const
{
    const std::uint32_t *const fragments = _fragments.Find({writer, sequence});
    return fragments != nullptr && fragment >= 1 && fragment <= *fragments;
}

}  // namespace Rabit::Rtps
