#include "recording/merge/ChannelChunks.h"

#include <algorithm>
#include <utility>

namespace Rabit::Merge
{

namespace
{

std::set<std::uint16_t> ChannelsOf(const Mcap::Contents &contents,
                                   const std::function<bool(const Mcap::Channel &)> &wants)
{
    std::set<std::uint16_t> channels;
    for (const auto &[id, channel] : contents.Channels)
    {
        if (wants(channel))
        {
            channels.insert(id);
        }
    }
    return channels;
}

}  // namespace

ChannelChunks::ChannelChunks(const Mcap::Contents &contents,
                             const std::function<bool(const Mcap::Channel &)> &wants)
    : ChannelChunks(contents, ChannelsOf(contents, wants))
{
}

ChannelChunks::ChannelChunks(const Mcap::Contents &contents, std::set<std::uint16_t> channels)
    : _channels(std::move(channels))
{
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
