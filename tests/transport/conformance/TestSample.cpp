#include "TestSample.h"

#include <algorithm>

namespace Rabit::Conformance
{
namespace
{
template <typename Action>
WriteResult OnceTaken(Action action)
{
    WriteResult result = action();
    while (result == WriteResult::TimedOut)
        result = action();
    return result;
}
}  // namespace

bool RawSample::Encode(std::span<std::uint8_t> buffer) const
{
    constexpr std::uint8_t Header[] = {0, 1, 0, 0};
    const auto body = std::copy(std::begin(Header), std::end(Header), buffer.begin());
    std::copy(_body.begin(), _body.end(), body);
    return true;
}

RawSample MakeSample(std::uint32_t key, const std::string &text)
{
    std::vector<std::uint8_t> body(4 + text.size());
    for (std::size_t i = 0; i < 4; ++i)
    {
        body[i] = static_cast<std::uint8_t>(key >> (8 * i));
    }
    std::copy(text.begin(), text.end(), body.begin() + 4);
    return RawSample(std::move(body));
}

std::string TextOf(SampleBytes bytes)
{
    return bytes.size() < 8 ? "" : std::string(bytes.begin() + 8, bytes.end());
}

KeyHash HashOf(std::uint32_t key)
{
    KeyHash hash{};
    for (std::size_t i = 0; i < 4; ++i)
    {
        hash[i] = static_cast<std::uint8_t>(key >> (24 - 8 * i));
    }
    return hash;
}

TopicDescription TextTopic(const std::string &name)
{
    return {name, "Test::Text", {}};
}

TopicDescription KeyedTopic(const std::string &name)
{
    return {name, "Test::KeyedText",
            [](SampleBytes bytes, KeyHash &hash)
            {
                if (bytes.size() < 8)
                {
                    return false;
                }
                hash = KeyHash{bytes[7], bytes[6], bytes[5], bytes[4]};
                return true;
            }};
}

WriteResult WriteOnceTaken(TransportWriter &writer, const SampleEncoder &sample, std::int64_t sourceTime)
{
    return OnceTaken([&] { return writer.Write(sample, sourceTime); });
}

WriteResult DisposeOnceTaken(TransportWriter &writer, const SampleEncoder &sample, std::int64_t sourceTime)
{
    return OnceTaken([&] { return writer.Dispose(sample, sourceTime); });
}

}  // namespace Rabit::Conformance
