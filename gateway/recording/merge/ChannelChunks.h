#pragma once

#include <rabit/mcap/McapContents.h>
#include <rabit/mcap/MessageCursor.h>

#include <functional>
#include <set>

namespace Rabit::Merge
{

// Selects channels of a file, and the chunks that hold them as far as the file's index tells. Other chunks
// need not be read.
class ChannelChunks
{
public:
    ChannelChunks(const Mcap::Contents &contents, const std::function<bool(const Mcap::Channel &)> &wants);
    ChannelChunks(const Mcap::Contents &contents, std::set<std::uint16_t> channels);

    // For a MessageCursor, which this must outlive.
    const Mcap::Contents &Contents() const { return _reduced; }
    Mcap::MessageCursor::Selection Selection() const;
    const std::set<std::uint16_t> &Channels() const { return _channels; }

private:
    Mcap::Contents _reduced;  // chunks alone
    std::set<std::uint16_t> _channels;
};

}  // namespace Rabit::Merge
