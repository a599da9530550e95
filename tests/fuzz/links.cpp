// Frames of queue links: the sample, the frame in it, and parts of types' texts.
#include <rabit/gateway/links/LinkFrameCodec.h>

#include "Input.h"
#include "wire/LinkSampleCodec.h"
#include "wire/TypeFrames.h"

namespace
{

void Decode(std::span<const std::uint8_t> bytes)
{
    Rabit::LinkFrame frame;
    if (Rabit::LinkFrameCodec::Decode(bytes, frame))
    {
        std::vector<std::uint8_t> again(Rabit::LinkFrameCodec::EncodedSize(frame));
        Rabit::LinkFrameCodec::Encode(frame, again);
        Rabit::LinkFrame same;
        Fuzz::Require(Rabit::LinkFrameCodec::Decode(again, same) &&
                      Rabit::LinkFrameCodec::EncodedSize(same) == again.size());
        std::vector<std::uint8_t> once(again.size());
        Rabit::LinkFrameCodec::Encode(same, once);
        Fuzz::Require(once == again);
    }
    if (const auto part = Rabit::TypeFrames::Decode(bytes))
    {
        Fuzz::Require(part->First + part->Bytes.size() <= part->Of &&
                      part->Of <= Rabit::TypeFrames::LargestText);
    }
}

}  // namespace

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    const std::vector<std::uint8_t> bytes(data, data + size);
    Decode(bytes);
    std::span<const std::uint8_t> frame;
    if (Rabit::OpenLinkSample(bytes, frame))
    {
        Decode(frame);
    }
    return 0;
}
