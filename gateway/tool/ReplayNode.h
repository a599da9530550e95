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
        std::string Qos;
    };
    // A message must not be listed twice. Throws NetworkError.
    ReplayNode(GatewayConfig network, const std::string &name, const std::vector<Topic> &topics,
               const CommonOptions &options, Wakeup &wakeup);

    // Returns false if the sample is not of the message's type.
    bool Post(const std::string &message, std::span<const std::uint8_t> sample, const PostTime &time);
    // Sends a sample to a queue of another node. False if it was refused, or is not of that type.
    bool Send(const std::string &address, const MessageType &type, std::span<const std::uint8_t> sample,
              const std::shared_ptr<RabitQueueReceipt> &receipt);

    // Waits until the gateway has taken the last value of that message, since it takes only the newest in
    // each of its turns. Ends early on Ctrl-C, after ten seconds, or, if the gateway was stuck before, after
    // 0.1 s.
    void WaitForItsTurn(const std::string &message);
    // Posts that were not written because a newer one replaced them.
    std::uint64_t Replaced() const;
    // True if another live node has its name.
    bool IsTwice() const { return _session.IsTwice(); }

private:
    struct Posted
    {
        std::shared_ptr<RabitMessage> Message;
        const MessageType *Type = nullptr;
        bool Waits = false;  // until the gateway takes it
    };

    const std::string _name;
    const Wakeup &_wakeup;
    bool _isStuck = false;  // the last wait for a turn ended early
    FleetSession _session;
    std::map<std::string, Posted> _posted;  // by message
};

}  // namespace Rabit::Tool
