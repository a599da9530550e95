#include "envelope/JoinMessages.h"

#include <algorithm>

#include "envelope/MergedMessage.h"

namespace Rabit::Rtps
{

std::size_t JoinMessages(const std::vector<std::vector<std::uint8_t>> &first, std::span<std::uint8_t> buffer,
                         std::size_t last)
{
    if (first.empty())
    {
        return last;
    }
    MergedMessage whole(buffer.size());
    const auto add = [&](std::span<const std::uint8_t> message)
    {
        if (!message.empty() && message.size() <= buffer.size())
        {
            whole.AddOfAny(message);
        }
    };
    for (const auto &message : first)
    {
        add(message);
    }
    add(buffer.first(last));
    std::copy(whole.Bytes().begin(), whole.Bytes().end(), buffer.begin());
    return whole.Bytes().size();
}

}  // namespace Rabit::Rtps
