// Several RTPS messages in one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/Rtps.h"

namespace Rabit::Rtps
{

// Joins RTPS messages (the parts) into one. A receiver reads each part as if it had come alone, and in the
// order of Add.
//
// A part may name its destination and its time, which then hold for all that follows (OMG DDSI-RTPS 2.3,
// 8.3.4). A part without them may follow: an INFO_DST of zeros or an INFO_TS without a time goes in between.
// The last submessage of a message may leave its length out, which is written out once a part follows.
//
// Not thread-safe.
class MergedMessage
{
public:
    // most: largest size of a message of several parts, in bytes.
    explicit MergedMessage(std::size_t most) : _most(most) {}

    // Adds a part of the same sender. Returns the number of bytes by which the message has grown; 0: the part
    // was not added, and belongs into another message. The first part is always added.
    //
    // Parts stay alone if they contain other submessages than those of samples, their repair, INFO_DST,
    // INFO_TS and padding: INFO_SRC and INFO_REPLY change how later submessages are read, and secured
    // submessages may cover the whole message. Nothing follows a part that does not end at a multiple of four
    // bytes.
    std::size_t Add(std::span<const std::uint8_t> part);
    // Like Add, but takes a part of any sender and content. An INFO_SRC names its sender where Add would
    // refuse it. For a reader on this host: on the air each message has one sender.
    std::size_t AddOfAny(std::span<const std::uint8_t> part);

    bool IsEmpty() const { return _bytes.empty(); }
    // The message.
    std::vector<std::uint8_t> &Bytes() { return _bytes; }

private:
    // The properties of a part that concern its neighbours.
    struct Content
    {
        bool IsPlain = true;            // Add takes it, and others behind it
        bool NamesDestination = false;  // has an INFO_DST
        bool NamesTime = false;         // has an INFO_TS
        bool LacksDestination = false;  // a submessage comes before any INFO_DST
        bool LacksTime = false;         // data comes before any INFO_TS
        bool HasDestination = false;    // holds at the end
        bool HasTime = false;           // holds at the end
        bool MayBeFollowed = true;
        std::size_t OpenAt = 0;  // offset of the last submessage, if it has no length; 0: it has one
    };
    static Content Read(std::span<const std::uint8_t> part);
    std::size_t Append(std::span<const std::uint8_t> part, const Content &content, bool namesSender);
    void WriteOutLength(std::size_t end);

    const std::size_t _most;
    std::vector<std::uint8_t> _bytes;
    std::vector<std::uint8_t> _sender;  // RTPS header of the last part
    Content _last;                      // state at the end of the message
};

}  // namespace Rabit::Rtps
