#include "common/DiscoveryParts.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "common/RtpsSubmessages.h"

namespace Rabit
{

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::uint8_t Pad = 0x01;
constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t Heartbeat = 0x07;
constexpr std::uint8_t InfoTimestamp = 0x09;
constexpr std::uint8_t InfoDestination = 0x0e;
constexpr std::uint8_t Data = 0x15;
// 9.3.1.2: the two highest bits of an entity's last byte.
constexpr std::uint8_t Builtin = 0xc0;
constexpr std::array<std::uint8_t, 4> PublicationsWriter{0x00, 0x00, 0x03, 0xc2};
constexpr std::array<std::uint8_t, 4> SubscriptionsWriter{0x00, 0x00, 0x04, 0xc2};
// In bodies. The reader comes first, but in samples.
constexpr std::size_t EntitiesInData = 4;
constexpr std::size_t EntitiesSize = 8;
constexpr std::size_t SequenceInData = EntitiesInData + EntitiesSize;
// Before the count, which an acknowledgement has at its end.
constexpr std::size_t HeartbeatContent = 24;
constexpr std::size_t CountSize = 4;
constexpr std::size_t Alignment = 4;  // 9.4.1: of where a submessage begins

using Submessage = RtpsSubmessage<const std::uint8_t>;

std::uint64_t DigestOf(std::span<const std::uint8_t> bytes)
{
    return std::hash<std::string_view>()({reinterpret_cast<const char *>(bytes.data()), bytes.size()});
}

// With its length said, which the last of a message need not.
void Append(const Submessage &submessage, std::vector<std::uint8_t> &bytes)
{
    const std::size_t at = bytes.size();
    bytes.insert(bytes.end(), submessage.Whole.begin(), submessage.Whole.end());
    const std::size_t length = submessage.Body().size();
    const auto low = static_cast<std::uint8_t>(length);
    const auto high = static_cast<std::uint8_t>(length >> 8);
    bytes[at + 2] = submessage.LittleEndian ? low : high;
    bytes[at + 3] = submessage.LittleEndian ? high : low;
}

void PutEntities(std::span<const std::uint8_t> entities, DiscoveryPart::Subject &about)
{
    std::copy_n(entities.begin(), about.Reader.size(), about.Reader.begin());
    std::copy_n(entities.begin() + static_cast<std::ptrdiff_t>(about.Reader.size()), about.Writer.size(),
                about.Writer.begin());
}

// False: it is none.
bool PutControl(const Submessage &submessage, DiscoveryPart &part)
{
    const auto body = submessage.Body();
    if (body.size() < EntitiesSize + CountSize)
    {
        return false;
    }
    PutEntities(body, part.About);
    const std::size_t said =
        submessage.Kind == AckNack ? body.size() - CountSize : std::min(HeartbeatContent, body.size());
    part.Content = 31 * submessage.Flags + DigestOf(body.first(said));
    Append(submessage, part.Bytes);
    return (part.About.Writer.back() & Builtin) == Builtin;
}

// False: they are none.
bool PutNews(const Submessage &submessage, const std::optional<Submessage> &timestamp, DiscoveryPart &part)
{
    const auto body = submessage.Body();
    if (body.size() < SequenceInData + part.About.Sequence.size() || body.size() > UINT16_MAX)
    {
        return false;
    }
    part.IsNews = true;
    PutEntities(body.subspan(EntitiesInData), part.About);
    std::copy_n(body.begin() + SequenceInData, part.About.Sequence.size(), part.About.Sequence.begin());
    // Whatever reader it is for.
    part.Content = DigestOf(body.subspan(SequenceInData));
    if (timestamp)
    {
        Append(*timestamp, part.Bytes);
    }
    Append(submessage, part.Bytes);
    return part.About.Writer == PublicationsWriter || part.About.Writer == SubscriptionsWriter;
}

}  // namespace

std::optional<std::vector<DiscoveryPart>> ReadDiscoveryParts(std::span<const std::uint8_t> datagram)
{
    std::vector<DiscoveryPart> parts;
    bool all = datagram.size() > RtpsHeaderSize;
    DiscoveryPart::Prefix to{};
    std::optional<Submessage> timestamp;
    const auto visit = [&](const Submessage &submessage)
    {
        if (submessage.Kind == Pad || !all)
        {
            return;
        }
        if (submessage.Kind == InfoTimestamp)
        {
            timestamp = submessage;
            return;
        }
        if (submessage.Kind == InfoDestination)
        {
            all = submessage.Body().size() == to.size();
            std::copy_n(submessage.Body().begin(), all ? to.size() : 0, to.begin());
            return;
        }
        DiscoveryPart part;
        part.About.To = to;
        part.About.Kind = submessage.Kind;
        const bool control = submessage.Kind == AckNack || submessage.Kind == Heartbeat;
        all = (control && PutControl(submessage, part)) ||
              (submessage.Kind == Data && PutNews(submessage, timestamp, part));
        all = all && part.Bytes.size() % Alignment == 0;
        parts.push_back(std::move(part));
    };
    VisitSubmessages(datagram, visit);
    return all && !parts.empty() ? std::optional(std::move(parts)) : std::nullopt;
}

DiscoveryPart ForAll(DiscoveryPart news)
{
    news.About.To = {};
    news.About.Reader = {};
    VisitSubmessages(std::span(news.Bytes), 0,
                     [](const RtpsSubmessage<std::uint8_t> &submessage)
                     {
                         if (submessage.Kind == Data)
                         {
                             std::fill_n(submessage.Body().begin() + EntitiesInData,
                                         std::tuple_size_v<DiscoveryPart::Entity>, std::uint8_t{0});
                         }
                     });
    return news;
}

}  // namespace Rabit
