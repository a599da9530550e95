#include "recording/merge/ChannelChunks.h"

#include <algorithm>

namespace Rabit::Merge
{

ChannelChunks::ChannelChunks(const Mcap::Contents &contents,
                             const std::function<bool(const Mcap::Channel &)> &wants)
{
    for (const auto &[id, channel] : contents.Channels)
    {
        if (wants(channel))
        {
            _channels.insert(id);
        }
    }
    for (const Mcap::ChunkIndex &chunk : contents.Chunks)
    {
        const bool isWanted =
            chunk.MessageIndexOffsets.empty() ||
            std::any_of(_channels.begin(), _channels.end(),
                        [&chunk](std::uint16_t id) { return chunk.MessageIndexOffsets.count(id) != 0; });
        if (isWanted && !_channels.empty())
        {
            _reduced.Chunks.push_back(chunk);
        }
    }
}

Mcap::MessageCursor::Selection ChannelChunks::Selection() const
{
    Mcap::MessageCursor::Selection selection;
    selection.Wants = [this](std::uint16_t channel) { return _channels.count(channel) != 0; };
    return selection;
}

}  // namespace Rabit::Merge
