// A file in memory, for writers and readers of recordings.
#pragma once

#include <rabit/mcap/ByteSink.h>
#include <rabit/mcap/ByteSource.h>

#include <algorithm>
#include <cstddef>
#include <utility>

class MemoryFile final : public Rabit::Mcap::ByteSink, public Rabit::Mcap::ByteSource
{
public:
    MemoryFile() = default;
    explicit MemoryFile(Rabit::Mcap::Bytes bytes) : Content(std::move(bytes)) {}

    bool Write(Rabit::Mcap::ByteView bytes) override
    {
        const std::size_t fits = std::min(bytes.size(), Room);
        Content.insert(Content.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(fits));
        Room -= fits;
        return fits == bytes.size();
    }
    std::uint64_t Size() override { return Content.size(); }
    bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override
    {
        if (offset > Content.size() || to.size() > Content.size() - offset)
        {
            return false;
        }
        std::copy_n(Content.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
        return true;
    }

    Rabit::Mcap::Bytes Content;
    std::size_t Room = std::size_t(-1);  // how much more is taken
};
