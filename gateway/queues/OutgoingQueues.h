#pragma once

#include <rabit/QueueForwarder.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/idl/MessageType.h>

#include <memory>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "presence/RemoteQueues.h"
#include "queues/LinkDriver.h"
#include "queues/LinkPayloadPool.h"
#include "queues/RefusalCounts.h"

namespace Rabit
{

// Queues of other nodes, as the managers of this one see them: takes a message added to `<node>/<queue>`,
// encodes it once, and passes it to the links, or refuses it at the call with a reason.
//
// Threads: any manager's thread calls Forward; Status and Problems are for any.
class OutgoingQueues final : public QueueForwarder
{
public:
    // References must outlive the object. The tap, if there is one, is told of messages that are refused
    // here.
    OutgoingQueues(const std::string &ownNode, RabitWorkspace &workspace, const RemoteQueues &remote,
                   LinkDriver &links, std::shared_ptr<GatewayTap> tap = nullptr);

    bool Handles(const std::string &queueName) const override;
    bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                 const std::shared_ptr<RabitQueueReceipt> &receipt) override;
    // The nodes that have announced themselves in this network; for `*` those that accept the message.
    std::vector<std::string> Known(const std::string &queueName, const RabitMessage &message) const override;
    void TakenElsewhere(const std::string &queueName) override;

    // The node is remembered no longer.
    void Forget(const std::string &node) { _refusals.Forget(node); }

    // All links to other nodes, with the messages that were refused before they reached a link.
    std::vector<Gateway::LinkStatus> Status() const;
    std::vector<Gateway::Problem> Problems();

private:
    using Receipt = std::shared_ptr<RabitQueueReceipt>;

    LinkPayload Encode(const MessageType &type, const RabitMessage &message) const;
    // The receipt has had its Begin for this message.
    bool ForwardTo(const std::string &node, const std::string &queue, const MessageType &type,
                   const LinkPayload &payload, const Receipt &receipt);
    bool ForwardToAll(const std::string &queue, const MessageType &type, const LinkPayload &payload,
                      const Receipt &receipt);
    void NoteRefusedThere();
    void TellRefused(const std::string &node, const std::string &queue, const MessageType &type,
                     const LinkPayload &payload, const std::string &reason) const;
    // Returns false.
    bool Refuse(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
                const std::string &reason, const Receipt &receipt);

    const std::string _ownNode;
    RabitWorkspace &_workspace;
    const RemoteQueues &_remote;
    LinkDriver &_links;
    const std::shared_ptr<LinkPayloadPool> _payloads = std::make_shared<LinkPayloadPool>();
    RefusalCounts _refusals;
    const std::shared_ptr<GatewayTap> _tap;
};

}  // namespace Rabit
