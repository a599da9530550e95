#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/idl/MessageType.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "CommonOptions.h"
#include "FleetSession.h"
#include "Wakeup.h"

namespace Rabit::Tool
{

// One node of a replay, in the network as long as the object lives. Main thread only.
class ReplayNode
{
public:
    struct Topic
    {
        std::string Message;
        const MessageType *Type = nullptr;
        bool IsTelemetry = false;
    };
    // No message twice. Throws NetworkError.
    ReplayNode(GatewayConfig network, const std::string &name, const std::vector<Topic> &topics,
               const CommonOptions &options, Wakeup &wakeup);

    // False if the sample is none of the message's type.
    bool Post(const std::string &message, std::span<const std::uint8_t> sample, const PostTime &time);
    // Puts it into a queue elsewhere. False if it was refused, or is none of that type.
    bool Send(const std::string &address, const MessageType &type, std::span<const std::uint8_t> sample,
              const std::shared_ptr<RabitQueueReceipt> &receipt);

    // The gateway takes the newest value of a message in each of its turns: waits until it has taken the last
    // one, or somebody wants the program to end; for ten seconds at most, and for 0.1 s after that.
    void WaitForItsTurn(const std::string &message);
    // Posts that were not written because a newer one came before their turn.
    std::uint64_t Replaced() const;
    // Whether another live node has its name.
    bool IsTwice() const;

private:
    struct Posted
    {
        std::shared_ptr<RabitMessage> Message;
        const MessageType *Type = nullptr;
        bool Waits = false;  // until the gateway takes it
    };

    const std::string _name;
    const Wakeup &_wakeup;
    bool _isStuck = false;  // the last turn was not waited for to its end
    FleetSession _session;
    std::map<std::string, Posted> _posted;  // by message
};

}  // namespace Rabit::Tool
