#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "recording/MessageTap.h"

namespace Rabit
{

// Finds the local messages that are to be recorded, and makes a MessageTap for each. Used by one manager.
class MessageTaps
{
public:
    // The workspace and the configuration must outlive the object. config.Record must be set.
    MessageTaps(const GatewayConfig &config, RabitWorkspace &workspace,
                std::shared_ptr<RecordingTarget> target);
    ~MessageTaps();
    // Begins to record new messages.
    void Look();
    // Messages that fit the rule are other nodes', as those of the configuration's rules. Any thread.
    void AddSubscription(const SubscribeRule &rule);

private:
    bool IsWanted(const std::string &name) const;
    bool IsTakenOver(const std::string &name) const;
    // The node that posts a message, and the message's name there.
    struct Origin
    {
        std::string Node;
        std::string Message;
        bool IsMirrored = false;
        bool IsState = true;
        std::string Qos{};  // in words, `none` if it is not published; empty: not known
    };
    Origin OriginOf(const std::string &name) const;
    std::shared_ptr<MessageTap> Tap(const std::string &name,
                                    const std::shared_ptr<PublishSubscribeMessage> &global);
    std::shared_ptr<MessageTap> TapManager(const std::shared_ptr<PublishSubscribeMessage> &global);

    const GatewayConfig &_config;
    mutable std::mutex _mutex;
    std::vector<SubscribeRule> _added;  // guarded; besides those of the configuration
    RabitWorkspace &_workspace;
    const std::shared_ptr<RecordingTarget> _target;
    struct Known
    {
        std::shared_ptr<PublishSubscribeMessage> Global;
        std::shared_ptr<MessageTap> Tap;  // null: it is not recorded
    };
    std::map<std::string, Known> _known;  // by name
    std::map<std::string, std::string> _notRecorded;
    std::uint32_t _managers;
};

}  // namespace Rabit
