#include "Sequence.h"

#include "common/RtpsReader.h"
#include "guard/DeliveryCheck.h"

namespace Opponent
{

void Hearing::Take(std::span<const std::uint8_t> datagram, TimePoint now)
{
    if (!Rabit::Rtps::HasRtpsHeader(datagram))
    {
        return;
    }
    const GuidPrefix name = Rabit::Rtps::SenderOf(datagram);
    const auto [numbers, isNew] = _numbers.try_emplace(name);
    if (isNew)
    {
        _names.push_back(name);
    }
    Bytes copy(datagram.begin(), datagram.end());
    Rabit::Rtps::VisitSubmessages(std::span<std::uint8_t>(copy),
                                  [&numbers = numbers->second](const Rabit::Rtps::Submessage &part)
                                  {
                                      const auto said = Rabit::Rtps::IsDelivery(part.Kind)
                                                            ? Rabit::Rtps::CheckDelivery(part)
                                                            : std::nullopt;
                                      if (said)
                                      {
                                          auto &highest = numbers[said->Writer];
                                          highest = std::max(highest, said->Last);
                                      }
                                  });
    _kept.emplace_back(now, std::move(copy));
    if (_kept.size() > MostKept)
    {
        _kept.pop_front();
    }
}

}  // namespace Opponent
