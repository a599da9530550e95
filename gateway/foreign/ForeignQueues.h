#pragma once

#include <rabit/QueueForwarder.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "foreign/ForeignOutbox.h"

namespace Rabit
{

// The queues whose messages go to topics of foreign programs, as the managers of this node see them. Any
// thread, once all queues are added.
class ForeignQueues final : public QueueForwarder
{
public:
    void Add(const std::string &name, std::shared_ptr<ForeignOutbox> outbox)
    {
        _outboxes.emplace(name, std::move(outbox));
    }

    bool Handles(const std::string &queueName) const override { return _outboxes.contains(queueName); }
    bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                 const std::shared_ptr<RabitQueueReceipt> &receipt) override
    {
        return _outboxes.at(queueName)->Add(*message, receipt);
    }

private:
    std::map<std::string, std::shared_ptr<ForeignOutbox>> _outboxes;
};

}  // namespace Rabit
