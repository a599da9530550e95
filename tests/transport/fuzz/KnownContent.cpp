#include "KnownContent.h"

#include <algorithm>
#include <functional>
#include <string_view>

namespace
{

constexpr std::size_t HeaderSize = 20;
constexpr std::size_t PrefixOffset = 8;
constexpr std::size_t PrefixSize = 12;
constexpr std::size_t SubmessageHeaderSize = 4;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFrag = 0x16;
constexpr std::uint8_t InfoSource = 0x0c;
constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t InlineQos = 0x02;
// Bits of an entity id that belongs to the protocol.
constexpr std::uint8_t Builtin = 0xc0;

std::size_t NumberAt(std::span<const std::uint8_t> bytes, std::size_t at, bool littleEndian)
{
    if (at + 2 > bytes.size())
    {
        return 0;
    }
    return littleEndian ? bytes[at] | std::size_t{bytes[at + 1]} << 8
                        : bytes[at + 1] | std::size_t{bytes[at]} << 8;
}

// Returns the bytes behind the inline parameters.
std::span<const std::uint8_t> BehindParameters(std::span<const std::uint8_t> list, bool littleEndian)
{
    constexpr std::size_t Sentinel = 1;
    std::size_t at = 0;
    while (at + 4 <= list.size())
    {
        const bool last = NumberAt(list, at, littleEndian) == Sentinel;
        at += 4 + (last ? 0 : NumberAt(list, at + 2, littleEndian));
        if (last)
        {
            break;
        }
    }
    return list.subspan(std::min(at, list.size()));
}

// Returns the content of a DATA or DATA_FRAG. `body` does not contain the submessage's header.
std::span<const std::uint8_t> ContentOf(std::span<const std::uint8_t> body, std::uint8_t kind,
                                        std::uint8_t flags)
{
    const bool littleEndian = (flags & LittleEndian) != 0;
    // The parameters begin 20 bytes into the body. In a DATA_FRAG, 12 bytes of fragment numbers come before
    // them.
    const std::size_t toParameters = kind == Data ? 20 : 32;
    if (body.size() < toParameters)
    {
        return {};
    }
    const auto rest = body.subspan(toParameters);
    return (flags & InlineQos) != 0 ? BehindParameters(rest, littleEndian) : rest;
}

}  // namespace

std::vector<KnownContent::Sample> KnownContent::SamplesOf(const Datagram &datagram)
{
    std::vector<Sample> samples;
    const std::span<const std::uint8_t> all(datagram);
    auto prefix = all.subspan(PrefixOffset, PrefixSize);
    std::size_t at = HeaderSize;
    while (at + SubmessageHeaderSize <= all.size())
    {
        const std::uint8_t kind = all[at];
        const std::uint8_t flags = all[at + 1];
        const std::size_t length = NumberAt(all, at + 2, (flags & LittleEndian) != 0);
        at += SubmessageHeaderSize;
        // The last submessage may have the length 0: it extends to the end of the datagram.
        const std::size_t left = all.size() - at;
        const std::size_t size =
            length == 0 && (kind == Data || kind == DataFrag) ? left : std::min(length, left);
        const auto body = all.subspan(at, size);
        at += size;
        if (kind == InfoSource && body.size() == HeaderSize)
        {
            prefix = body.subspan(PrefixOffset);
        }
        constexpr std::size_t WriterOffset = 8;
        constexpr std::size_t EntitySize = 4;
        const bool isSample = (kind == Data || kind == DataFrag) && body.size() >= WriterOffset + EntitySize;
        if (!isSample || (body[WriterOffset + EntitySize - 1] & Builtin) == Builtin)
        {
            continue;
        }
        Writer writer{};
        std::copy(prefix.begin(), prefix.end(), writer.begin());
        std::copy_n(body.begin() + WriterOffset, EntitySize, writer.begin() + PrefixSize);
        const auto content = ContentOf(body, kind, flags);
        const std::string_view text(reinterpret_cast<const char *>(content.data()), content.size());
        samples.emplace_back(writer, std::hash<std::string_view>()(text));
    }
    return samples;
}

void KnownContent::Learn(const std::vector<Datagram> &datagrams)
{
    for (const auto &datagram : datagrams)
    {
        const auto samples = SamplesOf(datagram);
        _known.insert(samples.begin(), samples.end());
    }
}

bool KnownContent::Covers(const Datagram &datagram) const
{
    if (datagram.size() < HeaderSize)
    {
        return true;
    }
    const auto samples = SamplesOf(datagram);
    return std::all_of(samples.begin(), samples.end(),
                       [this](const Sample &sample) { return _known.count(sample) > 0; });
}
