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
            found->FragmentSize == delivery.FragmentSize && found->SampleSize == delivery.SampleSize;
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
    _samples.push_back({.Sender = sender,
                        .Writer = delivery.Writer,
                        .Sequence = delivery.First,
                        .FragmentSize = delivery.FragmentSize,
                        .SampleSize = delivery.SampleSize,
                        .Parts = {}});
    return &_samples.back();
}

bool DiscoveryFragments::IsWhole(const Sample &sample)
{
    std::size_t next = 0;  // all bytes before it have come
    for (const auto &[first, bytes] : sample.Parts)
    {
        const std::size_t begin = std::size_t{first - 1} * sample.FragmentSize;
        if (begin > next)
        {
            return false;
        }
        next = std::max(next, begin + bytes.size());
    }
    return next == sample.SampleSize;
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
        std::min(std::size_t{delivery.LastFragment} * delivery.FragmentSize, std::size_t{sample->SampleSize});
    std::vector<std::uint8_t> &part = sample->Parts[delivery.FirstFragment];
    if (end - begin > part.size())
    {
        sample->Bytes += end - begin - part.size();
        part.assign(delivery.Payload.begin(),
                    delivery.Payload.begin() + static_cast<std::ptrdiff_t>(end - begin));
    }
    // Parts that overlap are no more than repeats need.
    if (!IsWhole(*sample))
    {
        if (sample->Bytes > 2 * std::size_t{sample->SampleSize})
        {
            Forget(*sample);
        }
        return {};
    }
    std::vector<std::uint8_t> whole(sample->SampleSize);
    for (const auto &[first, bytes] : sample->Parts)
    {
        const std::size_t at = std::size_t{first - 1} * sample->FragmentSize;
        std::copy(bytes.begin(), bytes.end(), whole.begin() + static_cast<std::ptrdiff_t>(at));
    }
    std::vector<std::uint8_t> message(header.begin(), header.begin() + RtpsHeaderSize);
    AppendDestination(message, destination);
    const std::size_t padding = (4 - whole.size() % 4) % 4;
    AppendSubmessageHeader(message, SubmessageKind::Data, 20 + whole.size() + padding, DataFlag);
    message.insert(message.end(), {0, 0, 16, 0});
    AppendEntity(message, delivery.Reader);
    AppendEntity(message, delivery.Writer);
    AppendSequence(message, delivery.First);
    Append(message, whole);
    message.insert(message.end(), padding, 0);
    Forget(*sample);
    return message;
}

void DiscoveryFragments::Forget(const Sample &sample)
{
    _samples.erase(std::find_if(_samples.begin(), _samples.end(),
                                [&sample](const Sample &each) { return &each == &sample; }));
}

}  // namespace Rabit::Rtps
