#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// A sample of rmw_dds_common/msg/ParticipantEntitiesInfo, written as its IDL has it: little-endian XCDR1.
class RosSample
{
public:
    // `gidSize`: 24 in ROS 2 Humble, 16 in later versions.
    RosSample(std::size_t gidSize, std::uint32_t nodes) : _gidSize(gidSize)
    {
        AddGid();
        AddNumber(nodes);
    }

    RosSample &AddNode(const std::string &space, const std::string &name, std::uint32_t readers,
                       std::uint32_t writers)
    {
        AddText(space);
        AddText(name);
        for (const std::uint32_t count : {readers, writers})
        {
            AddNumber(count);
            for (std::uint32_t i = 0; i < count; ++i)
            {
                AddGid();
            }
        }
        return *this;
    }
    std::vector<std::uint8_t> Bytes() const
    {
        std::vector<std::uint8_t> bytes{0, 1, 0, 0};
        bytes.insert(bytes.end(), _body.begin(), _body.end());
        return bytes;
    }

private:
    // 12 bytes of a prefix, 4 of an entity, and zeros.
    void AddGid()
    {
        std::vector<std::uint8_t> gid{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 1, 0xc1};
        gid.resize(_gidSize);
        _body.insert(_body.end(), gid.begin(), gid.end());
    }
    void AddNumber(std::uint32_t number)
    {
        _body.resize((_body.size() + 3) / 4 * 4);
        for (int shift = 0; shift < 32; shift += 8)
        {
            _body.push_back(static_cast<std::uint8_t>(number >> shift));
        }
    }
    void AddText(const std::string &text)
    {
        AddNumber(static_cast<std::uint32_t>(text.size() + 1));
        std::transform(text.begin(), text.end(), std::back_inserter(_body),
                       [](char letter) { return static_cast<std::uint8_t>(letter); });
        _body.push_back(0);
    }

    const std::size_t _gidSize;
    std::vector<std::uint8_t> _body;
};

}  // namespace Rabit::Tool
