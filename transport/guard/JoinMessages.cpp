#include "guard/JoinMessages.h"

#include <algorithm>

#include "common/RtpsWriter.h"

namespace Rabit::Rtps
{

namespace
{

constexpr std::size_t VersionAt = 4;

// Names the sender of the following submessages; destination: all; time: unknown (RTPS 2.3, 9.4.5).
void AppendSource(std::vector<std::uint8_t> &whole, std::span<const std::uint8_t> message)
{
    AppendSubmessageHeader(whole, SubmessageKind::InfoSource, RtpsHeaderSize);
    Append(whole, 0, 4);  // unused
    Append(whole, message.first(RtpsHeaderSize).subspan(VersionAt));
    AppendDestination(whole, {});
    AppendSubmessageHeader(whole, SubmessageKind::InfoTimestamp, 0, InvalidateFlag);
}

// Each submessage begins at a multiple of four, so the one before must end there.
bool MayBeFollowed(const std::vector<std::uint8_t> &whole)
{
    return whole.size() % SubmessageHeaderSize == 0;
}

}  // namespace

std::size_t JoinMessages(const std::vector<std::vector<std::uint8_t>> &first, std::span<std::uint8_t> buffer,
                         std::size_t last)
{
    if (first.empty())
    {
        return last;
    }
    std::vector<std::uint8_t> whole;
    const auto add = [&](std::span<const std::uint8_t> message)
    {
        if (message.empty() || !MayBeFollowed(whole))
        {
            return;
        }
        const std::size_t before = whole.size();
        if (before == 0)
        {
            whole.assign(message.begin(), message.end());
        }
        else
        {
            AppendSource(whole, message);
            whole.insert(whole.end(), message.begin() + RtpsHeaderSize, message.end());
        }
        if (whole.size() > buffer.size())
        {
            whole.resize(before);
        }
    };
    for (const auto &message : first)
    {
        add(message);
    }
    add(buffer.first(last));
    std::copy(whole.begin(), whole.end(), buffer.begin());
    return whole.size();
}

}  // namespace Rabit::Rtps
