#pragma once

#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitMessage.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "recording/RecordingTarget.h"

namespace Rabit
{

// Records each post of one local message, on the thread that posts it. A post that another thread replaces
// before it is recorded is counted as lost.
class MessageTap : public std::enable_shared_from_this<MessageTap>
{
public:
    // Encodes a message into `bytes`; false if it cannot be encoded.
    using Encode = std::function<bool(const RabitMessage &message, Mcap::Bytes &bytes)>;

    // `event` names the event that each post is for a black box; empty: none.
    MessageTap(std::shared_ptr<PublishSubscribeMessage> global, std::shared_ptr<RecordingTarget> target,
               std::uint32_t stream, Encode encode, std::string event = "");
    ~MessageTap();
    // Records the last post, if there is one, and from then on every post. To be called once.
    void Begin();

private:
    void OnPost();
    void Record();

    const std::shared_ptr<PublishSubscribeMessage> _global;
    const std::shared_ptr<RecordingTarget> _target;
    const std::uint32_t _stream;
    const Encode _encode;
    const std::string _event;
    RabitScopedConnection _connection;
    std::mutex _mutex;  // guards the members below: several threads may post
    std::unique_ptr<RabitMessage> _copy;
    std::uint64_t _seen = 0;  // posts that were recorded, or counted as lost, or before the beginning
};

}  // namespace Rabit
