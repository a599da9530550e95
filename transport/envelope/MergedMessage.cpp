#include "envelope/MergedMessage.h"

#include <algorithm>
#include <limits>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t VersionAt = 4;
constexpr std::size_t TimeSize = 8;

bool IsOfData(SubmessageKind kind)
{
    return kind == SubmessageKind::Data || kind == SubmessageKind::DataFrag;
}

// For these a length of 0 is a length; for all others it means up to the end of the message.
bool MayBeEmpty(SubmessageKind kind)
{
    return kind == SubmessageKind::Pad || kind == SubmessageKind::InfoTimestamp;
}

void AppendNoTime(std::vector<std::uint8_t> &message)
{
    AppendSubmessageHeader(message, SubmessageKind::InfoTimestamp, 0, InvalidateFlag);
}

// Names the sender of the submessages that follow; destination: all; time: unknown.
void AppendSource(std::vector<std::uint8_t> &message, std::span<const std::uint8_t> header)
{
    AppendSubmessageHeader(message, SubmessageKind::InfoSource, RtpsHeaderSize);
    Append(message, 0, 4);  // unused
    Append(message, header.subspan(VersionAt));
    AppendDestination(message, {});
    AppendNoTime(message);
}

}  // namespace

MergedMessage::Content MergedMessage::Read(std::span<const std::uint8_t> part)
{
    Content content;
    std::size_t end = RtpsHeaderSize;
    const auto visit = [&](const ConstSubmessage &submessage)
    {
        const std::size_t length = RtpsReader(submessage.Whole.subspan(2), submessage.LittleEndian).U16();
        const std::size_t body = submessage.Body().size();
        const bool isOpen = length == 0 && !MayBeEmpty(submessage.Kind);
        content.OpenAt = isOpen ? end : 0;
        // An empty body has no length that could be written out.
        const bool hasLength =
            isOpen ? body > 0 && body <= std::numeric_limits<std::uint16_t>::max() : length == body;
        content.MayBeFollowed = content.MayBeFollowed && hasLength;
        switch (submessage.Kind)
        {
            case SubmessageKind::Pad:
                break;
            case SubmessageKind::InfoDestination:
                content.IsPlain = content.IsPlain && body >= GuidPrefix().size();
                content.NamesDestination = true;
                content.HasDestination = PrefixOf(submessage.Body()) != GuidPrefix{};
                break;
            case SubmessageKind::InfoTimestamp:
                content.NamesTime = true;
                content.HasTime = (submessage.Flags & InvalidateFlag) == 0;
                content.IsPlain = content.IsPlain && (!content.HasTime || body >= TimeSize);
                break;
            default:
                content.IsPlain = content.IsPlain && IsDelivery(submessage.Kind);
                content.LacksDestination = content.LacksDestination || !content.NamesDestination;
                content.LacksTime = content.LacksTime || (!content.NamesTime && IsOfData(submessage.Kind));
                break;
        }
        end += submessage.Whole.size();
    };
    VisitSubmessages(part, visit);
    content.IsPlain = content.IsPlain && end == part.size();
    content.MayBeFollowed = content.MayBeFollowed && end == part.size() && end % SubmessageHeaderSize == 0;
    return content;
}

std::size_t MergedMessage::Add(std::span<const std::uint8_t> part)
{
    const Content content = Read(part);
    const bool joins = _last.IsPlain && content.IsPlain &&
                       std::ranges::equal(part.first(std::min(RtpsHeaderSize, part.size())), _sender);
    return IsEmpty() || joins ? Append(part, content, false) : 0;
}

std::size_t MergedMessage::AddOfAny(std::span<const std::uint8_t> part)
{
    const std::size_t grown = Add(part);
    return grown > 0 || part.size() < RtpsHeaderSize ? grown : Append(part, Read(part), true);
}

std::size_t MergedMessage::Append(std::span<const std::uint8_t> part, const Content &content,
                                  bool namesSender)
{
    const std::size_t before = _bytes.size();
    const bool isFirst = before == 0;
    if (!isFirst && !_last.MayBeFollowed)
    {
        return 0;
    }
    if (namesSender)
    {
        AppendSource(_bytes, part.first(RtpsHeaderSize));
    }
    const bool hasDestination = _last.HasDestination && !namesSender;
    const bool hasTime = _last.HasTime && !namesSender;
    const bool forgetsDestination = hasDestination && content.LacksDestination;
    const bool forgetsTime = hasTime && content.LacksTime;
    if (forgetsDestination)
    {
        AppendDestination(_bytes, {});
    }
    if (forgetsTime)
    {
        AppendNoTime(_bytes);
    }
    const std::size_t begin = isFirst ? 0 : RtpsHeaderSize;
    const std::size_t at = _bytes.size();
    if (!isFirst && at + part.size() - begin > _most)
    {
        _bytes.resize(before);
        return 0;
    }
    WriteOutLength(before);
    Rtps::Append(_bytes, part.subspan(begin));
    _sender.assign(part.begin(),
                   part.begin() + static_cast<std::ptrdiff_t>(std::min(RtpsHeaderSize, part.size())));
    _last = content;
    _last.HasDestination =
        content.NamesDestination ? content.HasDestination : hasDestination && !forgetsDestination;
    _last.HasTime = content.NamesTime ? content.HasTime : hasTime && !forgetsTime;
    _last.OpenAt = content.OpenAt > 0 ? at + content.OpenAt - begin : 0;
    return _bytes.size() - before;
}

// Of the last submessage, which ends at `end`.
void MergedMessage::WriteOutLength(std::size_t end)
{
    if (_last.OpenAt > 0)
    {
        const auto submessage = std::span(_bytes).first(end).subspan(_last.OpenAt);
        Write(submessage.subspan(2, 2), submessage.size() - SubmessageHeaderSize,
              (submessage[1] & LittleEndianFlag) != 0);
    }
}

}  // namespace Rabit::Rtps
