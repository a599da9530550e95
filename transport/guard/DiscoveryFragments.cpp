#include "guard/DiscoveryFragments.h"

#include <algorithm>

#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t MostSamples = 64;
constexpr std::uint32_t LargestAnnouncement = 60000;

}  // namespace

DiscoveryFragments::Sample *DiscoveryFragments::Find(const GuidPrefix &sender, const Delivery &delivery)
{
    const auto found = std::find_if(_samples.begin(), _samples.end(),
                                    [&](const Sample &sample) {
                                        return sample.Sender == sender && sample.Writer == delivery.Writer &&
                                               sample.Sequence == delivery.First;
                                    });
    if (found != _samples.end())
    {
        const bool same =
            found->FragmentSize == delivery.FragmentSize && found->Bytes.size() == delivery.SampleSize;
        return same ? &*found : nullptr;
    }
    if (delivery.SampleSize > LargestAnnouncement)
    {
        return nullptr;
    }
    if (_samples.size() >= MostSamples)
    {
        _samples.pop_front();
    }
    const std::size_t count =
        (std::size_t{delivery.SampleSize} + delivery.FragmentSize - 1) / delivery.FragmentSize;
    _samples.push_back({sender, delivery.Writer, delivery.First, delivery.FragmentSize,
                        std::vector<std::uint8_t>(delivery.SampleSize), std::vector<bool>(count, true)});
    return &_samples.back();
}

std::vector<std::uint8_t> DiscoveryFragments::Add(std::span<const std::uint8_t> header,
                                                  const Delivery &delivery, const GuidPrefix &destination)
{
    const GuidPrefix sender = SenderOf(header);
    Sample *sample = Find(sender, delivery);
    if (sample == nullptr)
    {
        return {};
    }
    const std::size_t begin = std::size_t{delivery.FirstFragment - 1} * delivery.FragmentSize;
    const std::size_t end =
        std::min(std::size_t{delivery.LastFragment} * delivery.FragmentSize, sample->Bytes.size());
    std::copy_n(delivery.Payload.begin(), end - begin,
                sample->Bytes.begin() + static_cast<std::ptrdiff_t>(begin));
    std::fill(sample->Missing.begin() + delivery.FirstFragment - 1,
              sample->Missing.begin() + delivery.LastFragment, false);
    if (std::find(sample->Missing.begin(), sample->Missing.end(), true) != sample->Missing.end())
    {
        return {};
    }
    std::vector<std::uint8_t> message(header.begin(), header.begin() + RtpsHeaderSize);
    AppendDestination(message, destination);
    const std::size_t padding = (4 - sample->Bytes.size() % 4) % 4;
    AppendSubmessageHeader(message, SubmessageKind::Data, 20 + sample->Bytes.size() + padding, DataFlag);
    message.insert(message.end(), {0, 0, 16, 0});
    AppendEntity(message, delivery.Reader);
    AppendEntity(message, delivery.Writer);
    AppendSequence(message, delivery.First);
    Append(message, sample->Bytes);
    message.insert(message.end(), padding, 0);
    _samples.erase(std::find_if(_samples.begin(), _samples.end(),
                                [sample](const Sample &each) { return &each == sample; }));
    return message;
}

}  // namespace Rabit::Rtps
