#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/idl/MessageType.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// The nodes of one participant of ROS 2, as it announces them (rmw_dds_common/msg/ParticipantEntitiesInfo).
// The samples of ROS 2 Humble, with GUIDs of 24 bytes, and those of later versions, with 16, have one type
// name. So a generated type would not read both.
class RosParticipant final : public RabitMessage
{
public:
    // Nodes that are kept. Further ones are ignored.
    static constexpr std::size_t MostNodes = 32;
    // Larger samples are refused: some 300 nodes with 200 readers and writers each.
    static constexpr std::size_t LargestSample = std::size_t{1} << 20;
    // The IDL type, with its name on the wire.
    static constexpr const char *TypeName = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

    std::string Prefix;              // of its GUID, as 24 hexadecimal digits
    std::vector<std::string> Nodes;  // with their namespaces: `/talker`, `/uav1/camera`

    // The type, which lives as long as the process. It reads samples and writes none.
    static const Rabit::MessageType &IdlType();

    // Takes over a sample: any bytes. Returns false, and is empty, if it makes no sense.
    bool Read(std::span<const std::uint8_t> sample);

    std::unique_ptr<RabitMessage> Clone() const override;
    bool CopyMessage(RabitMessage *msg) override;
    void Clear() override;

private:
    bool ReadBody(std::span<const std::uint8_t> body, bool littleEndian, std::size_t gidSize);
};

}  // namespace Rabit::Tool
