#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

void Write(std::span<std::uint8_t> bytes, std::uint64_t number, bool littleEndian)
{
    for (std::size_t i = 0; i < bytes.size(); ++i, number >>= 8)
    {
        bytes[littleEndian ? i : bytes.size() - 1 - i] = static_cast<std::uint8_t>(number);
    }
}

void WriteSequence(std::span<std::uint8_t> bytes, std::int64_t number, bool littleEndian)
{
    const auto bits = static_cast<std::uint64_t>(number);
    Write(bytes.first(4), bits >> 32, littleEndian);
    Write(bytes.subspan(4, 4), bits, littleEndian);
}

void Append(std::vector<std::uint8_t> &message, std::uint64_t number, std::size_t size)
{
    for (std::size_t i = 0; i < size; ++i)
    {
        message.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
}

void Append(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> bytes)
{
    message.insert(message.end(), bytes.begin(), bytes.end());
}

void AppendEntity(std::vector<std::uint8_t> &message, EntityId entity)
{
    for (int shift = 24; shift >= 0; shift -= 8)
    {
        message.push_back(static_cast<std::uint8_t>(entity >> shift));
    }
}

void AppendSequence(std::vector<std::uint8_t> &message, std::int64_t number)
{
    Append(message, static_cast<std::uint64_t>(number) >> 32, 4);
    Append(message, static_cast<std::uint64_t>(number), 4);
}

void AppendSubmessageHeader(std::vector<std::uint8_t> &message, SubmessageKind kind, std::size_t length,
                            std::uint8_t flags)
{
    message.insert(message.end(),
                   {static_cast<std::uint8_t>(kind), static_cast<std::uint8_t>(flags | LittleEndianFlag),
                    static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(length >> 8)});
}

void AppendParameter(std::vector<std::uint8_t> &message, std::uint16_t id,
                     std::span<const std::uint8_t> value)
{
    Append(message, id, 2);
    Append(message, value.size(), 2);
    Append(message, value);
}

void AppendDestination(std::vector<std::uint8_t> &message, const GuidPrefix &to)
{
    AppendSubmessageHeader(message, SubmessageKind::InfoDestination, to.size());
    Append(message, to);
}

}  // namespace Rabit::Rtps
