#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/idl/MessageType.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace Rabit
{

// One local queue into which other nodes may put messages. Not thread-safe, but for what it says of itself.
class AcceptedQueue
{
public:
    using Queue = RabitMessageQueue<std::shared_ptr<RabitMessage>>;

    // `wake` is called when a message was taken from the queue after it had been full: on the taker's thread,
    // and possibly for a moment after this object is gone. The rule must name known types.
    AcceptedQueue(const AcceptRule &rule, RabitWorkspace &workspace, std::function<void()> wake);

    const AcceptRule &Rule() const { return _rule; }
    // Looks the queue up: its manager may come later than the gateway, go, and come back with a new one.
    // Returns whether something changed.
    bool Find();
    // What keeps messages from being delivered; empty if nothing does.
    std::string Problem() const;

    // Decodes and adds a message without telling the queue's handlers: call Notify once no lock is held.
    LocalQueueResult Deliver(std::string_view type, std::span<const std::uint8_t> payload, bool redelivered);
    void Notify();
    std::size_t Room() const;
    // Whether room came since Deliver found the queue full.
    bool TakeRoomCame();

private:
    // Shared with the queue's pop event, which may fire while this object goes.
    struct Gate
    {
        std::atomic<bool> Full{false};
        std::atomic<bool> RoomCame{false};
        std::function<void()> Wake;
    };

    bool Add(const std::shared_ptr<RabitMessage> &message);

    AcceptRule _rule;
    RabitWorkspace &_workspace;
    std::map<std::string, const MessageType *, std::less<>> _types;
    std::shared_ptr<Queue> _queue;
    bool _wrongKind = false;
    std::shared_ptr<Gate> _gate;
    RabitScopedConnection _popped;
};

}  // namespace Rabit
